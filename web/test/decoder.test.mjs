// Compares the page's reading of a report with the other output files of the command:
//   TRAMMEL=.../trammel node --test decoder.test.mjs
import assert from 'node:assert/strict'
import { spawnSync } from 'node:child_process'
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { join } from 'node:path'
import { after, test } from 'node:test'
import { Achieved } from '../src/achieved.js'
import { underRunsText } from '../src/summary.js'
import { Bytes } from '../src/decode.js'
import { lastAtMost } from '../src/run.js'
import { readout, sample } from '../src/samples.js'
import { activeAt } from '../src/surroundings.js'
import { readPage, trammel, trammelStops } from './page.mjs'

const command = process.env.TRAMMEL
const examples = process.env.TRAMMEL_EXAMPLES
const folder = mkdtempSync(join(tmpdir(), 'trammel-'))
after(() => rmSync(folder, { recursive: true }))

function report(program, ...options) {
  const page = join(folder, 'report.html'), steps = join(folder, 'steps.csv'), json = join(folder, 'run.json')
  trammel(command, 'run', program, '--engine', 'model', '--report', page, '--steps', steps, '--json', json, ...options)
  const list = readFileSync(steps, 'utf8').trimEnd().split('\n').slice(1).map((row) => row.split(',').map(Number))
  return { ...readPage(page), list, json: JSON.parse(readFileSync(json, 'utf8')) }
}
function programOf(text) {
  const file = join(folder, 'program.ngc')
  writeFileSync(file, text)
  return file
}
// Checks each pulse of the list at its clock, by motor.
function expectPulses({ run, list }) {
  run.steps.forEach((steps, motor) => {
    const expected = list.filter((step) => step[1] === motor)
    assert.equal(steps.count, expected.length, `pulses of motor ${motor}`)
    let position = run.motors[motor].start
    expected.forEach(([cycle, , direction], i) => {
      position += direction
      assert.equal(steps.pins[i], cycle)
      assert.equal(steps.positions[i], position)
    })
  })
}
// The greatest distance, in pulses of an axis, between the commanded and the executed place at a step.
function worstPlace(run, counts = () => true) {
  let worst = 0
  for (let i = 0; i < run.executed.count; i += 7) {
    const cycle = run.executed.times[i]
    if (!counts(cycle)) continue
    const { motion } = run.motionAt(cycle)
    const stretch = run.stretchAt(motion)
    const share = run.shareAt(stretch, motion - run.motion.begins[stretch])
    const made = run.axes.map(({ start }, motor) => {
      const last = lastAtMost(run.steps[motor].cycles, cycle)
      return last < 0 ? start : run.steps[motor].positions[last]
    })
    run.axes.forEach((_, a) => {
      const off = run.axisAt(run.motion.paths[stretch], a, share)[0] - run.kinematics.coordinate(a, (motor) => made[motor])
      worst = Math.max(worst, Math.abs(off) / run.kinematics.pulseOf(a))
    })
  }
  return worst
}
const part = join(examples, 'part.ngc')

test('every pulse of a part is in the page, at its clock', () => {
  const made = report(part, '--clock', '1000000')
  assert.ok(made.list.length > 70000)
  expectPulses(made)
})

test('so it is through holds, overrides, a fast clock, and second motors', () => {
  expectPulses(report(part, '--clock', '1000000', '--hold-at', '2:1.5', '--override-at', '6:30'))
  expectPulses(report(part, '--clock', '50000000'))
  const gantry = join(folder, 'gantry.toml')
  writeFileSync(gantry, readFileSync(join(examples, 'machine.toml'), 'utf8').replace(/^\[axis\.x\]$/m, '[axis.x]\nsecond_motor = true'))
  const made = report(join(examples, 'relative.ngc'), '--machine', gantry)
  assert.equal(made.run.motors.length, made.run.axes.length + 1)
  expectPulses(made)
})

function expectDeviations({ run, json }) {
  let line = 0, arc = 0
  run.pathDeviation.forEach((deviation, path) => {
    if ((run.paths.flags[path] & 3) === 0) line = Math.max(line, deviation)
    else arc = Math.max(arc, deviation)
  })
  assert.ok(Math.abs(line - json.max_deviation.line) < 1e-5, `${line} ${json.max_deviation.line}`)
  assert.ok(Math.abs(arc - json.max_deviation.arc) < 1e-5, `${arc} ${json.max_deviation.arc}`)
}
test('the deviations that the page finds are those that the run measured', () => {
  const made = report(part, '--clock', '1000000')
  expectDeviations(made)
  const { run } = made
  const place = run.facts.deviation_places.line
  assert.ok(run.program[place.line - 1].length > 0)
})

// The commanded place at the clock of each step, compared with the executed pulses. The tolerance is half a pulse, plus
// the closing of arcs, plus the motion in the clocks by which the map of times may be off.
for (const [name, ...options] of [['at full speed'], ['held and overridden', '--hold-at', '2:1.5', '--override-at', '6:30'], ['S-curves', ...['x', 'y', 'z', 'e'].flatMap((axis) => ['--set', `axis.${axis}.max_jerk=20000`])]]) {
  test(`at every time the commanded place is the executed one: ${name}`, () => {
    const { run } = report(part, '--clock', '1000000', ...options)
    const worst = worstPlace(run)
    assert.ok(worst < 1.25, `${worst} pulses`)
  })
}

// By the machine's own formula X = (A + B) / 2, Y = (A - B) / 2, not by the page's ratios. A pulse of the path may be off
// by 1.25 pulses of each motor, so 1.25 mm / 80 in X or Y.
test('crossed belts: the path is that of the axes, the pulses are those of the motors', () => {
  const corexy = ['--set', "kinematics.name='corexy'"]
  const program = programOf('G21 G90 G91.1 G64 P0.2\nG1 X30 Y8 F3000\nG3 X30 Y28 J10\nG2 X42 Y28 Z3 I6\nG1 X10 Y20 Z9\nG18 G2 X20 Z9 I5 K0\nG17 G1 X-4 Y6 Z0 F1200\n')
  const made = report(program, '--clock', '1000000', ...corexy)
  expectPulses(made)
  const { run } = made
  for (let i = 0; i < run.executed.count; i += 11) {
    const [a, b] = [0, 1].map((motor) => {
      const last = lastAtMost(run.steps[motor].cycles, run.executed.times[i])
      return last < 0 ? 0 : run.steps[motor].positions[last] / 80
    })
    const [x, y] = run.executed.places.subarray(3 * i, 3 * i + 2)
    assert.ok(Math.abs(x + run.centre[0] - (a + b) / 2) < 1e-4 && Math.abs(y + run.centre[1] - (a - b) / 2) < 1e-4, `place ${i}`)
  }
  assert.ok(worstPlace(run) < 2.5, `${worstPlace(run)} half pulses`)
  assert.deepEqual([0, 1].map((axis) => run.coordinateAt(axis, run.cycles)), [-4, 6])
  assert.deepEqual(run.kinematics.names, ['X + Y', 'X − Y', 'Z', 'E'])
  const line = run.beginOfLine(7), { commanded, achieved, actual, axes } = readout(run, new Achieved(run), line + 0.5 * (run.cycles - line))
  assert.ok(Math.abs(commanded - 20) < 0.01 && Math.abs(achieved - 20) < 1, `${commanded} ${achieved}`)
  for (const a of [0, 1]) assert.ok(Math.abs(actual[a] - axes[a][1]) < 1, `${actual[a]} ${axes[a][1]}`)
  expectDeviations(report(programOf('G21 G90 G91.1\nG1 X30 Y8 F3000\nG3 X30 Y28 J10\nG2 X42 Y28 I6\nG1 X10\n'), '--clock', '1000000', ...corexy))
})

test('behind a probe the path goes on where it stopped', () => {
  const program = programOf('G21 G90\nG38.2 Z-10 F120\nG1 X4 F600\nG1 Z1\n')
  const made = report(program, '--clock', '1000000', '--set', 'probe.input=0', '--input-at', '1.5:0:1')
  expectPulses(made)
  const { run } = made
  const z = run.axes.findIndex((axis) => axis.letter === 'Z')
  const path = run.paths.lines.indexOf(3)
  const stood = run.axisFrom(path, z)
  assert.ok(stood < -2.5 && stood > -3.5, `${stood}`)
  assert.ok(worstPlace(run, (cycle) => cycle > run.pathBegin[path]) < 1.25)
  const last = run.positionAt(z, run.cycles)
  assert.equal(last, made.json.final_position[z])
})

test('commanded speed is the feed, and what the pulses make of it is the same', () => {
  const { run } = report(programOf('G21 G90 G91.1\nG1 X60 F600\nG2 I-10 F600\n'), '--clock', '1000000')
  const achieved = new Achieved(run)
  const samples = sample(run, achieved, 0.2 * run.cycles, 0.4 * run.cycles, 200)
  for (let i = 0; i < samples.path.length; ++i) {
    assert.ok(Math.abs(samples.path[i] - 10) < 0.01, `commanded ${samples.path[i]} at ${samples.x[i]}`)
    assert.ok(Math.abs(samples.mean[i] - 10) < 0.1, `achieved ${samples.mean[i]} at ${samples.x[i]}`)
  }
})

test('accelerations and jerks are those of the machine file, on straight lines to the last digit that floats have', () => {
  const program = programOf('G21 G90\nG1 X60 F6000\nG1 Y20 F6000\n')
  const machine = ['--set', 'axis.x.max_acceleration=500', '--set', 'axis.y.max_acceleration=800']
  const { run } = report(program, '--clock', '1000000', ...machine)
  const peaks = sample(run, new Achieved(run), 0, run.cycles, 2000).axes[1].map((values) => Math.max(...values.map(Math.abs)))
  assert.ok(Math.abs(peaks[0] / 500 - 1) < 0.01, `${peaks[0]}`)
  assert.ok(Math.abs(peaks[1] / 800 - 1) < 0.01, `${peaks[1]}`)
  const jerks = ['x', 'y', 'z', 'e'].flatMap((axis) => ['--set', `axis.${axis}.max_jerk=20000`])
  const curved = report(program, '--clock', '1000000', ...machine, ...jerks).run
  const jerk = sample(curved, new Achieved(curved), 0, curved.cycles, 2000).axes[2].map((values) => Math.max(...values.map(Math.abs)))
  assert.ok(Math.abs(jerk[0] / 20000 - 1) < 0.02, `${jerk[0]}`)
  assert.ok(jerk[1] / 20000 < 1.02, `${jerk[1]}`)
})

test('speed, acceleration and jerk are each the derivative of the one before, on lines, arcs and blends in space', () => {
  const jerks = ['x', 'y', 'z', 'e'].flatMap((axis) => ['--set', `axis.${axis}.max_jerk=30000`])
  const { run } = report(programOf('G21 G90 G91.1 G64 P1\nF3000\nG1 X30 Y8\nG3 X30 Y28 J10\nG1 X10 Y20 Z9\nG18 G2 X20 Z9 I5 K0\nG17 G1 X0 Y0 Z0\nG1 X20 Y30 Z10\nG1 X40 Y0 Z12\n'), '--clock', '1000000', ...jerks)
  const f = run.clockHz * run.fullRatio
  const kinds = new Set()
  let compared = 0
  for (let s = 0; s < run.motion.count; ++s) {
    const path = run.motion.paths[s]
    const clocks = run.motion.begins[s + 1] - run.motion.begins[s]
    if (clocks < 4000) continue
    const h = 200, t = clocks / 2
    const [before, now, behind] = [t - h, t, t + h].map((at) => run.axes.map((_, a) => run.axisAt(path, a, run.shareAt(s, at))))
    kinds.add(run.paths.flags[path] & 3)
    run.axes.forEach((axis, a) => {
      const bound = [axis.max_velocity, axis.max_acceleration, axis.max_jerk]
      for (let d = 0; d < 3; ++d) {
        const difference = (behind[a][d] - before[a][d]) / (2 * h) * f
        assert.ok(Math.abs(difference - now[a][d + 1]) < 2e-3 * bound[d], `line ${run.paths.lines[path]} ${axis.letter} ${d + 1}: ${difference} ${now[a][d + 1]}`)
        ++compared
      }
    })
  }
  assert.deepEqual([...kinds].sort(), [0, 1, 2])
  assert.ok(compared > 200, `${compared}`)
})

test('a hold and an override show where they were made', () => {
  const { run } = report(programOf('G21 G90\nG1 X60 F600\n'), '--clock', '1000000', '--hold-at', '2:1', '--override-at', '4:50')
  const percent = (seconds) => {
    const samples = sample(run, new Achieved(run), seconds * run.clockHz, (seconds + 0.2) * run.clockHz, 10)
    return samples.ratio.reduce((a, b) => a + b) / samples.ratio.length
  }
  assert.ok(Math.abs(percent(1) - 100) < 0.1, `${percent(1)}`)
  assert.ok(percent(2.4) < 1, `${percent(2.4)}`)
  assert.equal(readout(run, new Achieved(run), 2.5 * run.clockHz).percent, 0)
  assert.ok(Math.abs(percent(3.6) - 100) < 0.5, `${percent(3.6)}`)
  assert.ok(Math.abs(percent(5) - 50) < 0.5, `${percent(5)}`)
})

test('each line begins when the first pulse of its path comes', () => {
  const { run } = report(programOf('G21 G90\n(nothing)\nG1 X10 F600\nG4 P0.5\nG1 Y10\n'), '--clock', '1000000')
  const firstOf = (line) => run.executed.times[run.executed.paths.findIndex((path) => run.paths.lines[path] === line)]
  for (const line of [3, 5]) assert.ok(Math.abs(run.beginOfLine(line) - firstOf(line)) < 0.02 * run.clockHz, `line ${line}`)
  assert.equal(run.beginOfLine(2), run.beginOfLine(3))
  // The dwell is between them.
  assert.ok(run.beginOfLine(5) - run.beginOfLine(4) >= 0.5 * run.clockHz)
})

test('a window has its pulses alone, and the right positions', () => {
  const all = report(part, '--clock', '1000000')
  const some = report(part, '--clock', '1000000', '--report-window', '5:8')
  some.run.steps.forEach((steps, motor) => {
    const inside = all.run.steps[motor]
    const first = inside.cycles.findIndex((cycle) => cycle >= 5e6)
    const count = inside.cycles.filter((cycle) => cycle >= 5e6 && cycle <= 8e6).length
    assert.equal(steps.count, count)
    for (let i = 0; i < count; ++i) {
      assert.equal(steps.pins[i], inside.pins[first + i])
      assert.equal(steps.positions[i], inside.positions[first + i])
    }
    assert.equal(steps.count + some.run.motors[motor].beside, inside.count)
  })
  assert.deepEqual(some.run.executed.paths[0], all.run.executed.paths[all.run.executed.times.findIndex((t) => t >= 5e6)])
})

test('the program is in the page as it is, and nothing in it ends an element', () => {
  const text = 'G21\n; </script><script>alert(1)</script>\n; <img src=x onerror=alert(2)>\n(<!-- \u00e4 -->)\nG1 X1 F600\n'
  const file = join(folder, 'report.html')
  const { run } = report(programOf(text))
  assert.deepEqual(run.program, text.trimEnd().split('\n'))
  const html = readFileSync(file, 'utf8')
  assert.ok(!html.includes('alert('))
  assert.ok(html.startsWith('<!doctype html>') && html.trimEnd().endsWith('</html>'))
})

test('what does not go together is refused, and leaves no file', () => {
  const page = join(folder, 'refused.html')
  const refused = (...options) => {
    const { status, stderr } = spawnSync(command, ['run', part, ...options], { encoding: 'utf8' })
    assert.equal(status, 2, stderr)
    assert.ok(!existsSync(page))
    return stderr
  }
  assert.match(refused('--report', page, '--check'), /runs nothing/)
  assert.match(refused('--report', page, '--stream'), /whole program/)
  assert.match(refused('--report-window', '1:2'), /needs --report/)
  assert.match(refused('--report', page, '--report-window', '2:1'), /ends before it begins/)
  assert.match(refused('--report', page, '--report-window', '2'), /FROM:TO/)
})

test('under-runs are told with the time lost to them, unless somebody held the card', () => {
  const { facts } = report(programOf('G21 G90\nG1 X1 F600\n'))
  assert.equal(underRunsText(facts.run), '0')
  const told = { ...facts.run, under_runs: 1200, seconds: facts.run.planned_seconds + 0.5104 }
  assert.equal(underRunsText(told).replace(/\s/gu, ' '), '1 200, 0.510 s longer than planned')
  assert.equal(underRunsText({ ...told, under_runs: 2, events: [{ event: 'hold', cycle: 1 }] }), '2')
  assert.equal(underRunsText({ ...told, under_runs: null }), '–')
})

test('numbers of any size', () => {
  const bytes = new Bytes(Uint8Array.from([0x7f, 0x80, 0x01, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x0f, 3, 4]))
  assert.deepEqual([bytes.varint(), bytes.varint(), bytes.varint(), bytes.zigzag(), bytes.zigzag()], [127, 128, 2 ** 53 - 1, -2, 2])
})

test('without a request the override in force is 100 %, also where a card waits between two paths', () => {
  const { run } = report(part, '--clock', '1000000')
  const moving = Array.from(run.times.slopes).filter((slope) => slope > 0)
  assert.ok(moving.length > 10)
  for (const slope of moving) assert.equal(slope, run.fullRatio)
})

test('in a hold the actual speed of an axis is 0, and its sign is that of the motion', () => {
  const { run } = report(programOf('G21 G90\nG1 X60 F600\nG1 X50\n'), '--clock', '1000000', '--hold-at', '2:1')
  const achieved = new Achieved(run)
  const actual = (seconds) => readout(run, achieved, seconds * run.clockHz).actual[0]
  assert.ok(Math.abs(actual(1.5) - 10) < 0.2, `${actual(1.5)}`)
  assert.equal(actual(2.6), 0)
  assert.ok(Math.abs(actual(7.5) + 10) < 0.2, `${actual(7.5)}`)
})

// Runs with a machine behind the pins, and the limit switches of the default world as roles.
const roles = ['--set', 'inputs.x_limit_plus=1', '--set', 'inputs.feed_hold=6', '--set', 'inputs.cycle_start=7']
function stoppedBy(text, ...options) {
  const page = join(folder, 'stopped.html')
  const said = trammelStops(command, 'run', programOf(text), '--engine', 'model', '--clock', '400000', '--report', page, ...roles, ...options)
  return { ...readPage(page), said }
}

test('a limit stops the run, and its page ends there', () => {
  const { run, said } = stoppedBy('G21 G90\nG1 Y1 F3000\nG1 X350 F6000\nG1 Y20\n', '--world', 'default')
  assert.match(said, /stopped\.html shows the run up to its stop/)
  const [mark, ...others] = run.surroundings.marks
  assert.equal(others.length, 0)
  assert.deepEqual([mark.name, mark.reaction, mark.line], ['LIMIT (X plus)', 'immediate stop', 3])
  // The switch is at 300 mm; at 100 mm/s, the axis moves further for the filter time of 1 ms and the scan after it.
  assert.ok(mark.place[0] > 300 && mark.place[0] < 300.4, `${mark.place[0]} mm`)
  assert.ok(Math.abs(run.coordinateAt(0, mark.cycle) - mark.place[0]) <= 2 / 80, 'its pulses say the same')
  const lane = run.surroundings.lanes.find(({ name }) => name === 'X limit plus')
  assert.equal(lane.detail, 'input 1, x_plus')
  assert.equal(activeAt(lane, lane.times[0] - 1), 0)
  assert.equal(activeAt(lane, run.cycles), 1)
  const pressed = lane.times[0] / run.clockHz, stopped = mark.cycle / run.clockHz
  assert.ok(stopped > pressed && stopped - pressed < 0.004, `pressed at ${pressed} s, stopped at ${stopped} s`)
  assert.ok(Math.abs(run.coordinateAt(0, lane.times[0]) - 300) < 0.1, 'the switch is at 300 mm')
  assert.equal(run.paths.lines.at(-1), 3, 'the fourth line was never begun')
  assert.equal(run.paths.lines[run.pathAt(run.cycles)], 3)
  assert.ok(run.motion.paths.subarray(0, run.motion.count).every((path) => path < run.paths.count), 'nor is its motion there')
  assert.ok(run.times.cycles.at(-1) <= run.cycles, `motion until ${run.times.cycles.at(-1)} of ${run.cycles} clocks`)
})

test('an emergency stop on a ramp says so, and a button without a world', () => {
  const stop = '--set', reaction = 'outputs.on_emergency_stop="ramp"'
  const events = join(folder, 'events.txt')
  writeFileSync(events, 'at 400 ms press estop\n')
  const text = 'G21 G90\nG1 X100 F3000\n'
  for (const how of [['--world', 'default', '--world-events', events], ['--input-at', '0.4:estop:1']]) {
    const { run } = stoppedBy(text, stop, reaction, ...how)
    const [mark] = run.surroundings.marks
    assert.deepEqual([mark.name, mark.reaction, mark.line], ['EMERGENCY_STOP', 'ramp', 2])
    assert.ok(Math.abs(run.seconds(mark.cycle) - 0.4) < 0.001, `${run.seconds(mark.cycle)} s`)
    const lane = run.surroundings.lanes.find(({ input }) => input === 32)
    // The world's button bounces three times, the script's does not.
    assert.deepEqual([lane.begin, ...lane.states], how[0] === '--world' ? [0, 1, 0, 1, 0, 1, 0, 1] : [0, 1])
    assert.ok(Math.abs(run.seconds(lane.times[0]) - 0.4) < 0.001)
    // The axis continues on its ramp.
    assert.ok(run.coordinateAt(0, run.cycles) > mark.place[0] + 0.5)
  }
})

test('the feed hold button holds, and cycle start goes on', () => {
  const events = join(folder, 'events.txt')
  writeFileSync(events, ['at 400 ms press feed_hold', 'at 500 ms release feed_hold', 'at 900 ms press cycle_start', ''].join('\n'))
  const page = join(folder, 'held.html')
  trammel(command, 'run', programOf('G21 G90\nG1 X60 F3000\n'), '--engine', 'model', '--clock', '400000', '--report', page, ...roles,
    '--world', 'default', '--world-events', events)
  const { run } = readPage(page)
  const [mark] = run.surroundings.marks
  assert.deepEqual([mark.name, mark.reaction, mark.line], ['feed hold button', 'hold', 2])
  const held = run.seconds(mark.cycle)
  assert.ok(held > 0.4 && held < 0.412, `${held} s: filter, and a look each 5 ms`)
  assert.ok(run.seconds(mark.until) > 0.9 && run.seconds(mark.until) < 0.912)
  const lane = run.surroundings.lanes.find(({ name }) => name === 'feed hold')
  // Three bounces per change.
  assert.equal(lane.times.length, 2 * (1 + 2 * 3))
  assert.equal(activeAt(lane, 0.45 * run.clockHz), 1)
  assert.equal(run.surroundings.parted.length, 0)
})

test('where a weak motor loses steps, and how many', () => {
  const world = join(folder, 'weak.toml'), json = join(folder, 'world.json'), page = join(folder, 'weak.html')
  writeFileSync(world, '[axis.x]\ntorque = 0.045\n[axis.y]\n')
  trammel(command, 'run', programOf('G21 G90\nG1 X1 Y10 F100\nG1 X30 F9000\n'), '--engine', 'model', '--clock', '400000',
    '--world', world, '--json', json, '--report', page)
  const { run } = readPage(page)
  const end = JSON.parse(readFileSync(json, 'utf8')).world.axes[0]
  assert.ok(end.lost !== 0)
  const [x, y] = run.surroundings.apart
  assert.deepEqual(run.surroundings.parted.map(({ letter }) => letter), ['X'])
  assert.equal(x.lost, end.lost)
  assert.ok(Math.abs(x.most_lost) >= Math.abs(x.lost))
  // In the second line, not in the slow first one; the curve shows more than two full steps from then on.
  const begun = run.surroundings.marks.find(({ parting }) => parting)
  assert.equal(begun.line, 3)
  assert.ok(Math.abs(run.surroundings.apartAt(0, begun.cycle - 0.02 * run.clockHz)) < 2 * 16 / 80)
  const after = Math.abs(run.surroundings.apartAt(0, begun.cycle + 0.01 * run.clockHz))
  assert.ok(after >= 2 * 16 / 80, `${after} mm`)
  assert.ok(y.pulses.every((pulses) => Math.abs(pulses) < 2 * 16))
  assert.ok(Math.abs(run.surroundings.apartAt(0, run.cycles) - (end.commanded - end.carriage) / 80) < 0.4)
})

// The page's data of a run: commanded motion and executed steps on one time axis, in card clocks. Does not use the
// document.
import { Kinematics } from './kinematics.js'
import { Surroundings } from './surroundings.js'
import { decodeMotion, decodePaths, decodeSteps, decodeTimes, kArc, kLine, kPause, kSpaceArc } from './decode.js'

// The last index whose value is <= x; -1 if there is none.
export function lastAtMost(values, x, count = values.length) {
  let low = 0, high = count
  while (low < high) {
    const middle = (low + high) >>> 1
    if (values[middle] <= x) low = middle + 1
    else high = middle
  }
  return low - 1
}

const empty = new Uint8Array(0)
const kWait = 64  // clocks that a card may wait between two paths, with a margin

// The override in force. It changes only after a request; a few missing clocks elsewhere are waits between two paths.
class InForce {
  constructor(full, events) {
    this.full = full
    this.goal = this.running = full
    this.settled = false
    this.requests = events.filter(({ event }) => ['override', 'hold', 'resume'].includes(event))
    this.next = 0
  }
  // The ratio for a slope of the map of times, which is accurate to 3 clocks. Slopes must come in order.
  of(slope, begin, end) {
    for (; this.next < this.requests.length && this.requests[this.next].cycle < end; ++this.next) this.take(this.requests[this.next])
    const off = Math.abs(slope - this.goal) * (end - begin)
    if (off < 4) this.settled = true
    return off < (this.settled ? kWait : 4) ? this.goal : slope
  }
  take({ event, percent }) {
    if (event === 'override') this.running = percent / 100 * this.full
    this.goal = event === 'hold' ? 0 : this.running
    this.settled = false
  }
}

export class Run {
  constructor(streams, facts) {
    const { machine, run } = facts
    this.facts = run
    this.machine = machine
    this.clockHz = machine.clock_hz
    this.motors = machine.motors
    this.axes = machine.motors.slice(0, machine.axes)
    this.kinematics = new Kinematics(machine)
    this.cycles = Math.max(1, run.cycles)
    this.fullRatio = 1 / machine.max_override  // of enabled clocks, at 100 %
    this.start = this.axes.map((axis) => axis.start)  // pulses, by motor
    const text = new TextDecoder().decode(streams.get('program') ?? empty)
    this.program = text.split('\n')
    if (this.program.at(-1) === '') this.program.pop()
    // Indices of X, Y and Z among the axes; -1 if the machine does not have the axis.
    this.space = ['X', 'Y', 'Z'].map((letter) => this.axes.findIndex((axis) => axis.letter === letter))
    this.steps = this.motors.map((motor, i) => decodeSteps(
      streams.get(`steps-${i}`) ?? empty, streams.get(`delays-${i}`) ?? empty, motor.start + motor.before))
    this.pulses = this.steps.reduce((sum, steps) => sum + steps.count, 0)
    this.paths = decodePaths(streams.get('paths') ?? empty, this.axes.length, this.start)
    this.motion = decodeMotion(streams.get('motion') ?? empty)
    this.stopped = run.stopped != null
    if (this.stopped) this.leaveOutUnbegun()
    this.placeInTime(decodeTimes(streams.get('times') ?? empty))
    this.placeOnPaths()
    this.mergeSteps()
    this.lineIndex()
    this.surroundings = new Surroundings(this, streams)
  }
  // Removes motion that was sent but never began, in a run that did not reach its end.
  leaveOutUnbegun() {
    const { motion, paths } = this
    while (motion.count > 0 && motion.paths[motion.count - 1] >= paths.count) --motion.count
  }

  // ---- time: card clocks and the motion clock

  placeInTime(points) {
    const motions = [], cycles = [], slopes = []
    const inForce = new InForce(this.fullRatio, this.facts.events)
    this.gaps = []  // card clocks between two stretches, without commanded motion
    const total = this.motion.begins[this.motion.count] ?? 0
    for (let i = 0; i < points.length;) {
      let end = i + 1
      while (end < points.length && !points[end].first) ++end
      const slope = (a, b) => inForce.of((b.motion - a.motion) / (b.cycle - a.cycle), a.cycle, b.cycle)
      const inner = []
      for (let p = i; p + 1 < end; ++p) inner.push(slope(points[p], points[p + 1]))
      const usable = (value) => value > 0.01 ? value : this.fullRatio
      const first = points[i], last = points[end - 1]
      const enter = usable(inner[0] ?? 0), leave = usable(inner.at(-1) ?? 0)
      const stop = end < points.length ? points[end].begin : this.stopped ? last.motion : total
      const from = Math.max(cycles.at(-1) ?? 0, first.cycle - (first.motion - first.begin) / enter)
      if (cycles.length) this.gaps.push([cycles.at(-1), from])
      else if (from > 0) this.gaps.push([0, from])
      const put = (motion, cycle, after) => { motions.push(motion); cycles.push(cycle); slopes.push(after) }
      put(first.begin, from, enter)
      for (let p = i; p < end; ++p) put(points[p].motion, points[p].cycle, inner[p - i] ?? leave)
      // Motion that a probe has cut off takes no time.
      const whole = last.cycle + Math.max(0, stop - last.motion) / leave
      const next = points[end]
      const latest = next ? next.cycle - (next.motion - next.begin) / this.fullRatio : Infinity
      put(stop, whole <= latest ? whole : Math.max(last.cycle, Math.min(whole, latest)), 0)
      i = end
    }
    if (cycles.length) this.gaps.push([cycles.at(-1), Math.max(this.cycles, cycles.at(-1))])
    this.times = { motions: Float64Array.from(motions), cycles: Float64Array.from(cycles), slopes: Float64Array.from(slopes) }
  }

  // The motion clock at a card clock, and its rate.
  motionAt(cycle) {
    const { motions, cycles, slopes } = this.times
    const i = lastAtMost(cycles, cycle)
    if (i < 0) return { motion: motions[0] ?? 0, ratio: 0 }
    if (i + 1 >= cycles.length || slopes[i] === 0) return { motion: motions[i], ratio: 0 }
    const share = (cycle - cycles[i]) / (cycles[i + 1] - cycles[i])
    return { motion: motions[i] + share * (motions[i + 1] - motions[i]), ratio: slopes[i] }
  }
  // Whether the last request before a card clock was a hold.
  heldAt(cycle) {
    const requests = this.facts.events.filter(({ event, cycle: at }) => at <= cycle && (event === 'hold' || event === 'resume'))
    return requests.at(-1)?.event === 'hold'
  }
  // The last card clock with this value of the motion clock: the end of a pause.
  cycleAt(motion) {
    const { motions, cycles } = this.times
    const i = lastAtMost(motions, motion)
    if (i < 0) return cycles[0] ?? 0
    if (i + 1 >= motions.length || motions[i + 1] === motions[i]) return cycles[i]
    return cycles[i] + (motion - motions[i]) / (motions[i + 1] - motions[i]) * (cycles[i + 1] - cycles[i])
  }
  seconds(cycle) { return cycle / this.clockHz }

  // ---- commanded

  // Computes for each stretch the ticks before it on its path, and the beginning of each path.
  placeOnPaths() {
    const { paths, motion } = this
    this.ticksBefore = new Float64Array(motion.count)
    this.pathTicks = new Float64Array(paths.count)
    this.pathBegin = new Float64Array(paths.count).fill(-1)  // card clocks
    this.pathMotion = new Float64Array(paths.count).fill(-1)
    const pathStop = new Float64Array(paths.count)
    for (let s = 0; s < motion.count; ++s) {
      const p = motion.paths[s]
      pathStop[p] = motion.begins[s + 1]
      if (this.pathMotion[p] < 0) this.pathMotion[p] = motion.begins[s]
      this.ticksBefore[s] = this.pathTicks[p]
      const t = motion.begins[s + 1] - motion.begins[s]
      this.pathTicks[p] += t * (motion.rates[s] + t * (motion.accelerations[s] / 2 + t * motion.jerks[s] / 6))
    }
    // A pause, and a path without its own stretch, begin at the end of the previous one.
    let at = 0
    for (let p = 0; p < paths.count; ++p) {
      if (this.pathMotion[p] < 0) this.pathMotion[p] = at
      else at = pathStop[p]
    }
    for (let p = 0; p < paths.count; ++p) {
      const pause = (paths.flags[p] & 3) === kPause
      this.pathBegin[p] = pause ? this.cycleBefore(this.pathMotion[p]) : this.cycleAt(this.pathMotion[p])
    }
  }
  // The first card clock with this value of the motion clock: the beginning of a pause.
  cycleBefore(motion) {
    const { motions, cycles } = this.times
    let i = lastAtMost(motions, motion)
    while (i > 0 && motions[i - 1] === motion) --i
    if (i < 0) return 0
    return motions[i] === motion ? cycles[i] : this.cycleAt(motion)
  }
  // Start and end of a path, in pulses of a motor.
  startOf(path, motor) {
    if (this.paths.flags[path] & 512) return this.paths.starts.get(path)[motor]
    return path > 0 ? this.endOf(path - 1, motor) : this.start[motor]
  }
  endOf(path, motor) { return this.paths.ends[path * this.axes.length + motor] }
  // mm of an axis.
  axisFrom(path, axis) { return this.kinematics.coordinate(axis, (motor) => this.startOf(path, motor)) }
  axisTo(path, axis) { return this.kinematics.coordinate(axis, (motor) => this.endOf(path, motor)) }

  // The stretch at a motion clock.
  stretchAt(motion) { return Math.min(lastAtMost(this.motion.begins, motion, this.motion.count), this.motion.count - 1) }

  // Completed share of its path, and the first three derivatives with respect to seconds, at an override of 100 %.
  shareAt(stretch, clocks) {
    const { motion } = this
    const v = motion.rates[stretch], a = motion.accelerations[stretch], j = motion.jerks[stretch]
    const all = this.pathTicks[motion.paths[stretch]] || 1
    const f = this.clockHz * this.fullRatio
    return [
      (this.ticksBefore[stretch] + clocks * (v + clocks * (a / 2 + clocks * j / 6))) / all,
      (v + clocks * (a + clocks * j / 2)) / all * f,
      (a + clocks * j) / all * f * f,
      j / all * f * f * f,
    ]
  }

  // Motion of an axis (mm, mm/s, mm/s^2, mm/s^3) on a path, from the share and its derivatives.
  axisAt(path, axis, [share, v, a, j]) {
    const from = this.axisFrom(path, axis)
    const way = this.axisTo(path, axis) - from
    const kind = this.paths.flags[path] & 3
    const arc = kind === kArc || kind === kSpaceArc ? this.paths.arcs.get(path) : null
    const place = arc ? arc.plane.indexOf(axis) : -1
    if (place < 0) return [from + share * way, way * v, way * a, way * j]
    const turn = this.turnOf(path, arc)
    const w = turn * v, dw = turn * a, ddw = turn * j
    let cosine, sine, radius, centre
    if (kind === kArc) {
      const { angle, r0, r1, at } = this.circleOf(path, arc)
      radius = r0 + share * (r1 - r0)
      const phi = angle + turn * share - (place === 1 ? Math.PI / 2 : 0)
      cosine = Math.cos(phi) * radius
      sine = Math.sin(phi) * radius
      centre = at[place]
    } else {
      const phi = turn * share
      const { first, second } = arc
      cosine = arc.radius * (Math.cos(phi) * first[place] + Math.sin(phi) * second[place])
      sine = arc.radius * (Math.sin(phi) * first[place] - Math.cos(phi) * second[place])
      centre = arc.centre[place]
    }
    return [
      centre + cosine,
      -sine * w,
      -cosine * w * w - sine * dw,
      sine * w * w * w - 3 * cosine * w * dw - sine * ddw,
    ]
  }
  turnOf(path, arc) { return this.paths.flags[path] & 16 ? -arc.sweep : arc.sweep }
  // Radii at both ends and centre, in mm, and the angle at the start.
  circleOf(path, arc) {
    if (arc.circle) return arc.circle
    const at = arc.centre
    const dx = this.axisFrom(path, arc.plane[0]) - at[0], dy = this.axisFrom(path, arc.plane[1]) - at[1]
    const r0 = Math.hypot(dx, dy)
    const r1 = Math.hypot(this.axisTo(path, arc.plane[0]) - at[0], this.axisTo(path, arc.plane[1]) - at[1])
    return arc.circle = { at, r0, r1, angle: Math.atan2(dy, dx) }
  }
  // Point of the commanded path, X Y Z in mm.
  pointAt(path, share) {
    return this.space.map((axis) => axis < 0 ? 0 : this.axisAt(path, axis, [share, 0, 0, 0])[0])
  }
  // Speed along the path in mm/s, at 100 %.
  pathSpeed(path, v) { return this.paths.lengths[path] * v }
  // The largest ratio of an axis's acceleration to its limit.
  loadAt(path, derivatives) {
    let most = 0
    for (let a = 0; a < this.axes.length; ++a) {
      const share = Math.abs(this.axisAt(path, a, derivatives)[2]) / this.axes[a].max_acceleration
      if (share > most) most = share
    }
    return most
  }

  // ---- executed

  // Merges the steps of all axes in one clock into one place (X Y Z, mm), with the path of the steps and the distance
  // from it.
  mergeSteps() {
    const { steps, axes, space } = this
    let count = 0
    const capacity = axes.reduce((sum, _, a) => sum + steps[a].count, 0)
    const times = new Float64Array(capacity), path = new Uint32Array(capacity), deviation = new Float32Array(capacity)
    const places = new Float32Array(3 * capacity)
    const next = axes.map(() => 0)
    const here = axes.map((axis, a) => axis.start + this.motors[a].before)
    const made = (motor) => here[motor]
    this.centre = this.centreOf()
    let on = -1, left = 0
    const enter = () => {
      do left += this.paths.stepClocks[++on] ?? Infinity
      while (left <= 0)
      this.judgeOf(on)
    }
    enter()
    for (let skip = this.machine.clocks_before; skip > 0;) {
      const some = Math.min(skip, left)
      skip -= some
      left -= some
      if (left <= 0) enter()
    }
    for (;;) {
      let now = Infinity
      for (let a = 0; a < axes.length; ++a) {
        if (next[a] < steps[a].count && steps[a].cycles[next[a]] < now) now = steps[a].cycles[next[a]]
      }
      if (now === Infinity) break
      for (let a = 0; a < axes.length; ++a) {
        if (next[a] < steps[a].count && steps[a].cycles[next[a]] === now) here[a] = steps[a].positions[next[a]++]
      }
      if (left <= 0) enter()
      --left
      times[count] = now
      path[count] = on
      deviation[count] = this.judge(here)
      for (let i = 0; i < 3; ++i) {
        if (space[i] >= 0) places[3 * count + i] = this.kinematics.coordinate(space[i], made) - this.centre[i]
      }
      ++count
    }
    this.executed = {
      count, times: times.subarray(0, count), paths: path.subarray(0, count),
      deviations: deviation.subarray(0, count), places: places.subarray(0, 3 * count),
    }
    this.pathDeviation = new Float32Array(this.paths.count)
    for (let i = 0; i < count; ++i) {
      if (deviation[i] > this.pathDeviation[path[i]]) this.pathDeviation[path[i]] = deviation[i]
    }
  }
  // The middle of the commanded path, the origin for single-precision numbers.
  centreOf() {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity]
    for (let p = -1; p < this.paths.count; ++p) {
      for (let i = 0; i < 3; ++i) {
        const axis = this.space[i]
        const at = axis < 0 ? 0 : p < 0 ? this.startCoordinate(axis) : this.axisTo(p, axis)
        low[i] = Math.min(low[i], at)
        high[i] = Math.max(high[i], at)
      }
    }
    return low.map((x, i) => (x + high[i]) / 2)
  }
  startCoordinate(axis) { return this.kinematics.coordinate(axis, (motor) => this.start[motor]) }
  // Prepares judge() for a path: distance in pulses from its line, or from the annulus between the radii of its arc's
  // ends.
  judgeOf(path) {
    this.judged = null
    if (path >= this.paths.count) return
    const kind = this.paths.flags[path] & 3
    const n = this.axes.length
    if (kind === kLine) {
      const from = [], along = []
      let square = 0
      for (let a = 0; a < n; ++a) {
        from.push(this.startOf(path, a))
        along.push(this.endOf(path, a) - from[a])
        square += along[a] * along[a]
      }
      this.judged = { from, along, square }
    } else if (kind === kArc) {
      const arc = this.paths.arcs.get(path)
      const circle = this.kinematics.circle(arc)
      if (!circle) return
      const { motors: [x, y], at } = circle
      const r0 = Math.hypot(this.startOf(path, x) - at[0], this.startOf(path, y) - at[1])
      const r1 = Math.hypot(this.endOf(path, x) - at[0], this.endOf(path, y) - at[1])
      this.judged = { arc: true, x, y, at, inner: Math.min(r0, r1), outer: Math.max(r0, r1) }
    }
  }
  judge(here) {
    const j = this.judged
    if (!j) return 0
    if (j.arc) {
      const r = Math.hypot(here[j.x] - j.at[0], here[j.y] - j.at[1])
      return Math.max(0, r - j.outer, j.inner - r)
    }
    if (j.square === 0) return 0
    let dot = 0
    for (let a = 0; a < here.length; ++a) dot += (here[a] - j.from[a]) * j.along[a]
    dot /= j.square
    let square = 0
    for (let a = 0; a < here.length; ++a) {
      const off = here[a] - j.from[a] - dot * j.along[a]
      square += off * off
    }
    return Math.sqrt(square)
  }

  // Position of a motor in pulses, at its pin, at a card clock.
  positionAt(motor, cycle) {
    const steps = this.steps[motor]
    const i = lastAtMost(steps.pins, cycle)
    return i < 0 ? this.motors[motor].start + this.motors[motor].before : steps.positions[i]
  }
  // Position of an axis in mm at a card clock, from the pulses at the pins.
  coordinateAt(axis, cycle) { return this.kinematics.coordinate(axis, (motor) => this.positionAt(motor, cycle)) }

  // ---- program

  lineIndex() {
    this.firstPath = new Int32Array(this.program.length + 2).fill(-1)
    for (let p = this.paths.count - 1; p >= 0; --p) this.firstPath[this.paths.lines[p]] = p
  }
  // The current path, or the last one.
  pathAt(cycle) { return Math.max(0, lastAtMost(this.pathBegin, cycle)) }
  // The beginning of a line; for one without motion, that of the next line with motion.
  beginOfLine(line) {
    for (let i = line; i < this.firstPath.length; ++i) {
      if (this.firstPath[i] >= 0) return this.pathBegin[this.firstPath[i]]
    }
    return this.cycles
  }
}

// The summary of the run, in words and numbers.
import { make } from './dom.js'
import { duration, fixed, grouped, millimetres, number } from './format.js'
import { kPause } from './decode.js'
import { placeText } from './surroundings.js'

// Seconds and millimetres of feed moves and rapids, and seconds at rest.
export function totalsOf(run) {
  const { paths } = run
  const totals = { feed: 0, rapid: 0, pauses: 0, stops: 0 }
  for (let p = 0; p < paths.count; ++p) {
    if ((paths.flags[p] & 3) === kPause) {
      totals.pauses += paths.pauses.get(p) ?? 0
      continue
    }
    totals[paths.flags[p] & 4 ? 'rapid' : 'feed'] += paths.lengths[p]
    if (paths.flags[p] & 32) ++totals.stops
  }
  return totals
}

// Holds caused by under-runs and the time lost, outside the operator's holds and changes of speed.
export function underRunsText({ under_runs: count, events, seconds, planned_seconds: planned }) {
  if (count == null) return '–'
  return count > 0 && events.length === 0 ? `${grouped(count)}, ${fixed(seconds - planned, 3)} s longer than planned` : grouped(count)
}

export function fillSummary(element, run, goToLine, goTo) {
  const { facts } = run
  const totals = totalsOf(run)
  const line = (n) => make('button', { class: 'go', onclick: () => goToLine(n), title: 'Go there' }, `line ${n}`)
  const table = (head, rows) => make('table', {},
    head ? make('thead', {}, make('tr', {}, ...head.map((text) => make('th', {}, text)))) : null,
    make('tbody', {}, ...rows.map((cells) => make('tr', {}, ...cells.map((cell) => make('td', {}, cell))))))
  const add = (title, ...content) => element.append(make('h2', {}, title), ...content)

  if (facts.stopped != null) add('Stopped', make('p', {}, `${facts.stopped.replace(/^./, (c) => c.toUpperCase())}. What was not begun by then is not in this page.`))
  add('Run', table(null, [
    ['Time', duration(run.seconds(run.cycles))],
    ['Planned', duration(facts.planned_seconds)],
    ['With a feed', millimetres(totals.feed)],
    ['Rapids', millimetres(totals.rapid)],
    ['Pauses', duration(totals.pauses)],
    ['Stops', grouped(totals.stops)],
    ['Path segments', grouped(facts.segments)],
    ['Commands', grouped(facts.commands)],
    ['Speeds', facts.profile === 's-curve' ? 'S-curve' : String(facts.profile)],
    ['Mean feed', facts.feed.achieved == null ? '–' : `${number(facts.feed.achieved)} of ${number(facts.feed.commanded)} mm/min`],
    ['Under-runs', underRunsText(facts)],
    ['Engine', facts.lockstep_cycles == null ? 'golden model' : 'RTL in lockstep with the golden model'],
    ['Clock', `${number(run.clockHz / 1e6)} MHz`],
  ]))
  const coordinate = (axis, pulses) => run.kinematics.coordinate(axis, (motor) => pulses[motor])
  add('Axes', table(['', 'ends at, mm'], run.axes.map((axis, a) => [axis.letter, fixed(coordinate(a, facts.final_position), 3)])))
  add('Motors', table(['', 'pulses', 'ends at, pulses'], run.axes.map((_, a) => [
    run.kinematics.names[a], grouped(facts.steps[a]), String(facts.final_position[a])])))
  const place = (name) => {
    const at = facts.deviation_places[name]
    if (!at) return '–'
    const where = run.axes.slice(0, 3).map(({ letter }, a) => `${letter} ${fixed(coordinate(a, at.position), 3)}`).join(', ')
    return make('span', {}, line(at.line), ` at ${where}`)
  }
  add('Largest deviations', table(null, ['line', 'arc'].map((name) => [
    `${name === 'line' ? 'Lines' : 'Arcs'} ${fixed(facts.max_deviation[name], 3)} pulses`, place(name)])))
  const feeds = facts.feeds_not_reached
  add('Feed not reached', feeds.length
    ? table(['why', 'moves', 'worst'], feeds.map((feed) => [
      feed.cause, grouped(feed.count),
      make('span', {}, line(feed.line), make('br'), `${number(feed.reached)} of ${number(feed.commanded)} mm/min`)]))
    : make('p', {}, 'Every move reaches its feed.'))
  if (facts.events.length) {
    add('Overrides, holds and inputs', table(null, facts.events.map((event) => [
      make('button', { class: 'go', onclick: () => goTo(event.cycle) }, `${fixed(run.seconds(event.cycle), 4)} s`),
      event.event === 'override' ? `override ${number(event.percent)} %`
        : event.event === 'input' ? `input ${event.input} ${event.level ? 'high' : 'low'}` : event.event])))
  }
  fillSurroundings(run, add, table, line, goTo)
  const words = Object.entries(facts.accepted_words)
  if (words.length) {
    add('Words without effect', make('p', {}, words.map(([word, count]) => `${word} (${count})`).join(', ')))
  }
  if (run.machine.window) {
    const [from, to] = run.machine.window
    const beside = run.motors.reduce((sum, motor) => sum + motor.beside, 0)
    add('Window', make('p', {}, `Pulses from ${fixed(run.seconds(from), 3)} s to ${fixed(run.seconds(Math.min(to, run.cycles)), 3)} s are in this page; ${grouped(beside)} others are not.`))
  }
}

// Causes with their reactions, and the motion of a machine behind the pins.
function fillSurroundings(run, add, table, line, goTo) {
  const { surroundings, facts } = run
  const when = (cycle) => make('button', { class: 'go', onclick: () => goTo(cycle), title: 'Go there' }, `${fixed(run.seconds(cycle), 4)} s`)
  const causes = surroundings.marks.filter(({ parting }) => !parting)
  if (causes.length) {
    add('Causes and reactions', table(['cause', 'reaction'], causes.map((mark) => [
      make('span', {}, mark.name, make('br'), `${placeText(run, mark.place)} mm`),
      make('span', {}, mark.reaction, make('br'), when(mark.cycle), make('br'), line(mark.line)),
    ])))
  }
  const changed = surroundings.lanes.filter(({ times }) => times.length)
  if (changed.length) {
    add('Inputs', table(['', 'edges', 'first', 'last'], changed.map(({ name, times }) => [
      name, grouped(times.length), when(times[0]), when(times.at(-1))])))
  }
  if (!facts.world) return
  const lost = (axis, pulses) => `${grouped(pulses).replace('-', '−')} steps, ${fixed(pulses / axis.pulses_per_mm, 3)} mm`
  add('Pulses and carriages', surroundings.parted.length
    ? table(['', 'lost'], surroundings.parted.map((axis) => [
      make('span', {}, `${axis.letter} from `, when(axis.began), ' on'),
      make('span', {}, lost(axis, axis.commanded - axis.carriage), ' at the end', make('br'), lost(axis, axis.most_lost), ' at most')]))
    : make('p', {}, 'No carriage has lost its place.'))
}

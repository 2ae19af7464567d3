// Events around the card: inputs by role, causes with their reactions, and differences between pulses and carriages.
// Does not use the document.
import { Bytes } from './decode.js'
import { fixed } from './format.js'
import { lastAtMost } from './run.js'

const kEmergencyStop = 32  // number of the emergency stop's pin among the inputs

const empty = new Uint8Array(0)

// Changes of pins: clocks, and the numbers of the pins that change at these clocks.
export function decodeInputs(data) {
  const bytes = new Bytes(data)
  const changes = []
  let cycle = 0
  while (!bytes.done) {
    cycle += bytes.varint()
    const changed = bytes.varint()
    for (let input = 0; input <= kEmergencyStop; ++input) {
      if (Math.floor(changed / 2 ** input) % 2) changes.push({ cycle, input })
    }
  }
  return changes
}

// Clocks, and the number of pulses by which the card's count is ahead of the carriage from then on.
export function decodeApart(data) {
  const bytes = new Bytes(data)
  const times = [], pulses = []
  let cycle = 0, now = 0
  while (!bytes.done) {
    times.push(cycle += bytes.varint())
    pulses.push(now += bytes.zigzag())
  }
  return { times: Float64Array.from(times), pulses: Float64Array.from(pulses) }
}

// An input over time: clocks at which it changes, and whether it is active from then on.
function laneOf(lane, changes) {
  const times = [], active = []
  let level = lane.level
  for (const change of changes) {
    if (change.input !== lane.input) continue
    const next = change.level ?? 1 - level
    if (next === level) continue
    level = next
    times.push(change.cycle)
    active.push(level === lane.active ? 1 : 0)
  }
  return { ...lane, begin: lane.level === lane.active ? 1 : 0, times: Float64Array.from(times), states: Uint8Array.from(active) }
}

export class Surroundings {
  constructor(run, streams) {
    const { facts } = run
    // Inputs that the operator's script sets have no stream.
    const scripted = facts.events.filter(({ event }) => event === 'input' || event === 'emergency stop').map((event) => ({
      cycle: event.cycle, input: event.event === 'input' ? event.input : kEmergencyStop,
      level: event.event === 'input' ? event.level : event.pressed ? 1 : 0,
    }))
    const changes = [...decodeInputs(streams.get('inputs') ?? empty), ...scripted].sort((a, b) => a.cycle - b.cycle)
    this.lanes = (facts.lanes ?? []).map((lane) => laneOf(lane, changes))
    this.apart = (facts.world?.axes ?? []).map((axis, n) => ({
      ...axis, ...decodeApart(streams.get(`apart-${n}`) ?? empty), letter: axis.axis,
    }))
    this.parted = this.apart.filter((axis) => axis.began != null)
    this.marks = this.marksOf(run)
  }
  marksOf(run) {
    const at = (cycle) => run.axes.map((_, a) => run.coordinateAt(a, cycle))
    const lineAt = (cycle) => run.paths.count ? run.paths.lines[run.pathAt(cycle)] : 0
    const holds = run.facts.events.filter(({ event }) => event === 'hold')
      .map(({ cycle }) => ({ name: 'hold', reaction: 'hold', cycle, line: lineAt(cycle), operator: true }))
    const parting = this.parted.map(({ letter, began }) => ({
      name: `${letter} loses steps`, reaction: '', cycle: began, line: lineAt(began), parting: true,
    }))
    const place = ({ position, cycle }) => position
      ? run.axes.map((_, a) => run.kinematics.coordinate(a, (motor) => position[motor])) : at(cycle)
    return [...run.facts.causes ?? [], ...holds, ...parting].sort((a, b) => a.cycle - b.cycle)
      .map((mark) => ({ ...mark, place: place(mark) }))
  }
  // Position of an axis of the simulated machine in mm, at a card clock.
  apartAt(n, cycle) {
    const { times, pulses, pulses_per_mm: scale } = this.apart[n]
    const i = lastAtMost(times, cycle)
    return i < 0 ? 0 : pulses[i] / scale
  }
  // Whether a row is shown from the start; a hold by the operator's script does not need one, because the override
  // shows it.
  get busy() { return this.marks.some(({ operator }) => !operator) || this.lanes.some(({ times }) => times.length > 0) }
}

export const activeAt = (lane, cycle) => {
  const i = lastAtMost(lane.times, cycle)
  return i < 0 ? lane.begin : lane.states[i]
}
// X 300.013 Y 0.000: for the axes that move in the run.
export function placeText(run, place) {
  const moves = (axis) => run.kinematics.inverse[axis].some(({ motor }) => run.steps[motor].count > 0 || run.motors[motor].beside > 0)
  return run.axes.flatMap(({ letter }, a) => moves(a) ? [`${letter} ${fixed(place[a], 3)}`] : []).join(' ')
}

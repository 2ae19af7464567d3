// Decodes the report's streams, in the format of the writer (host/report). Runs in a browser and in Node.

export class Bytes {
  constructor(data) {
    this.data = data
    this.at = 0
    this.view = new DataView(data.buffer, data.byteOffset, data.byteLength)
  }
  get done() { return this.at >= this.data.length }
  varint() {
    const data = this.data
    let byte = data[this.at++]
    let value = byte & 0x7f
    // Bit operations would lose bits beyond 2^31; numbers have 53 bits.
    for (let scale = 128; byte & 0x80; scale *= 128) {
      byte = data[this.at++]
      value += (byte & 0x7f) * scale
    }
    return value
  }
  zigzag() {
    const value = this.varint()
    return value % 2 ? -(value + 1) / 2 : value / 2
  }
  f32() { const value = this.view.getFloat32(this.at, true); this.at += 4; return value }
  f64() { const value = this.view.getFloat64(this.at, true); this.at += 8; return value }
}

// The number of varints: each has exactly one byte without the highest bit.
export function countVarints(data) {
  let count = 0
  for (let i = 0; i < data.length; ++i) count += data[i] < 0x80 ? 1 : 0
  return count
}

// The steps of one motor: clocks at which they reached the shaper and the pin, and positions after them (pulses).
export function decodeSteps(stepData, delayData, start) {
  const count = countVarints(stepData)
  const cycles = new Float64Array(count)
  const pins = new Float64Array(count)
  const positions = new Int32Array(count)
  const steps = new Bytes(stepData)
  const delays = new Bytes(delayData)
  let cycle = 0, interval = 0, direction = 1, position = start
  let delay = 0
  let left = delays.done ? Infinity : delays.varint()
  for (let i = 0; i < count; ++i) {
    const value = steps.varint()
    const turn = value % 2
    const zigzag = (value - turn) / 2
    interval += zigzag % 2 ? -(zigzag + 1) / 2 : zigzag / 2
    if (turn) direction = -direction
    cycle += interval
    position += direction
    while (left === 0) {
      delay += delays.zigzag()
      left = delays.done ? Infinity : delays.varint()
    }
    --left
    cycles[i] = cycle
    pins[i] = cycle + delay
    positions[i] = position
  }
  return { count, cycles, pins, positions }
}

export const kLine = 0, kArc = 1, kSpaceArc = 2, kPause = 3

// The commanded blocks, in columns; `start` and `ends`: pulses by motor, arcs in mm by axis of the machine.
export function decodePaths(data, axes, start) {
  const bytes = new Bytes(data)
  const flags = [], lines = [], stepClocks = [], ticks = [], lengths = [], wanted = [], speeds = [], ends = []
  const arcs = new Map(), pauses = new Map(), starts = new Map()
  let line = 0
  const here = Array.from(start)
  while (!bytes.done) {
    const index = flags.length
    const flag = bytes.varint()
    line += bytes.zigzag()
    flags.push(flag)
    lines.push(line)
    if ((flag & 3) === kPause) {
      pauses.set(index, bytes.f64())
      stepClocks.push(0); ticks.push(0); lengths.push(0); wanted.push(0); speeds.push(0)
      for (let a = 0; a < axes; ++a) ends.push(here[a])
      continue
    }
    if (flag & 512) {
      for (let a = 0; a < axes; ++a) here[a] += bytes.zigzag()
      starts.set(index, Array.from(here))
    }
    stepClocks.push(bytes.varint())
    for (let a = 0; a < axes; ++a) ends.push(here[a] += bytes.zigzag())
    ticks.push(bytes.varint())
    lengths.push(bytes.f64())
    wanted.push(bytes.f32())
    speeds.push(bytes.f32())
    if ((flag & 3) === kArc) {
      const plane = [bytes.varint(), bytes.varint()]
      const centre = [bytes.f64(), bytes.f64()]
      arcs.set(index, { plane, centre, sweep: bytes.f64() })
    } else if ((flag & 3) === kSpaceArc) {
      const plane = [bytes.varint(), bytes.varint(), bytes.varint()]
      const three = () => [bytes.f64(), bytes.f64(), bytes.f64()]
      const arc = { plane, centre: three(), first: three(), second: three() }
      arc.radius = bytes.f64()
      arc.sweep = bytes.f64()
      arcs.set(index, arc)
    }
  }
  return {
    count: flags.length, flags: Uint32Array.from(flags), lines: Uint32Array.from(lines),
    stepClocks: Float64Array.from(stepClocks), ticks: Float64Array.from(ticks), lengths: Float64Array.from(lengths),
    wanted: Float32Array.from(wanted), speeds: Float32Array.from(speeds), ends: Float64Array.from(ends), arcs, pauses, starts,
  }
}

// Stretches of one path with one feed piece: their beginning on the motion clock, and rate, acceleration and jerk
// there, in ticks and clocks.
export function decodeMotion(data) {
  const bytes = new Bytes(data)
  const paths = [], begins = [], rates = [], accelerations = [], jerks = []
  let path = 0, clock = 0
  while (!bytes.done) {
    path += bytes.varint()
    paths.push(path)
    begins.push(clock)
    clock += bytes.varint()
    rates.push(bytes.f32())
    accelerations.push(bytes.f32())
    jerks.push(bytes.f32())
  }
  begins.push(clock)
  return {
    count: paths.length, paths: Uint32Array.from(paths), begins: Float64Array.from(begins),
    rates: Float32Array.from(rates), accelerations: Float32Array.from(accelerations), jerks: Float32Array.from(jerks),
  }
}

// Points of motion clock and card clock; `begin` of a stretch's first point is the value of the motion clock before it.
export function decodeTimes(data) {
  const bytes = new Bytes(data)
  const points = []
  let motion = 0, cycle = 0
  while (!bytes.done) {
    const value = bytes.varint()
    const first = value % 2 === 1
    motion += (value - (first ? 1 : 0)) / 2
    cycle += bytes.varint()
    points.push({ motion, cycle, first, begin: first ? motion - bytes.varint() : 0 })
  }
  return points
}

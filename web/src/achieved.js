// The speed along the path from the intervals between the pulses at the pins: constant between two pulses of an axis.
// If an interval is more than four times the previous or the next one, the axis stood still in its middle.
import { lastAtMost } from './run.js'

const kStoodStill = 4
const kBlock = 64

// Speed of one motor, pulses per second times `perStep`, negative for backward motion, from each of `times` on.
function motorSpeeds(steps, perStep) {
  const { pins, positions, count } = steps
  const times = new Float64Array(3 * count + 1), speeds = new Float32Array(3 * count + 1)
  let n = 0
  const put = (time, speed) => {
    if (n > 0 && time <= times[n - 1]) time = times[n - 1]
    times[n] = time
    speeds[n++] = speed
  }
  for (let i = 0; i + 1 < count; ++i) {
    const interval = pins[i + 1] - pins[i]
    const before = i > 0 ? pins[i] - pins[i - 1] : interval
    const behind = i + 2 < count ? pins[i + 2] - pins[i + 1] : interval
    const back = positions[i + 1] === (i > 0 ? positions[i - 1] : NaN)
    const way = perStep * Math.sign(positions[i + 1] - positions[i])
    if (interval <= kStoodStill * before && interval <= kStoodStill * behind) {
      put(pins[i], back ? 0 : way / interval)
      continue
    }
    const left = Math.min(before, interval), right = Math.min(behind, interval)
    put(pins[i], (back ? -way : way) / left)
    put(pins[i] + left / 2, 0)
    put(pins[i + 1] - right / 2, way / right)
  }
  if (count > 0) {
    const last = count > 1 ? pins[count - 1] - pins[count - 2] : 0
    if (last > 0) put(pins[count - 1], 0)
  }
  return { times: times.subarray(0, n), speeds: speeds.subarray(0, n) }
}

// The sum of the speeds of several motors.
function sumOf(parts) {
  if (parts.length === 1) return parts[0]
  const capacity = parts.reduce((sum, { times }) => sum + times.length, 0)
  const times = new Float64Array(capacity), speeds = new Float32Array(capacity)
  const count = mergeSpeeds(parts, (now, time, n) => {
    times[n] = time
    speeds[n] = now.reduce((a, b) => a + b)
  })
  return { times: times.subarray(0, count), speeds: speeds.subarray(0, count) }
}

// Calls `put` for each time at which a speed changes, with all speeds, the time, and its number; returns the number of
// times.
function mergeSpeeds(parts, put) {
  const next = parts.map(() => 0), now = new Float64Array(parts.length)
  for (let n = 0; ; ++n) {
    let time = Infinity
    for (let a = 0; a < parts.length; ++a) {
      if (next[a] < parts[a].times.length && parts[a].times[next[a]] < time) time = parts[a].times[next[a]]
    }
    if (time === Infinity) return n
    for (let a = 0; a < parts.length; ++a) {
      while (next[a] < parts[a].times.length && parts[a].times[next[a]] <= time) now[a] = parts[a].speeds[next[a]++]
    }
    put(now, time, n)
  }
}

export class Achieved {
  constructor(run) {
    const f = run.clockHz
    const of = (axis) => sumOf(run.kinematics.inverse[axis].map(({ motor, mm }) => motorSpeeds(run.steps[motor], f * mm)))
    const inSpace = run.space.filter((axis) => axis >= 0)
    const beside = run.axes.map((_, axis) => axis).filter((axis) => !inSpace.includes(axis))
    this.axes = run.axes.map((_, axis) => of(axis))
    const alone = (axis) => this.axes[axis]
    this.merge(inSpace.map(alone), beside.map(alone))
    this.summarise()
  }
  // Along X Y Z; if none of these moves, along the other axes.
  merge(space, beside) {
    const all = [...space, ...beside]
    const capacity = all.reduce((sum, one) => sum + one.times.length, 0)
    const times = new Float64Array(capacity), speeds = new Float32Array(capacity)
    const n = mergeSpeeds(all, (now, time, i) => {
      let square = 0
      for (let a = 0; a < space.length; ++a) square += now[a] * now[a]
      if (square === 0) for (let a = space.length; a < all.length; ++a) square += now[a] * now[a]
      times[i] = time
      speeds[i] = Math.sqrt(square)
    })
    this.times = times.subarray(0, n)
    this.speeds = speeds.subarray(0, n)
  }
  // Minimum, maximum and sum over time of each kBlock values.
  summarise() {
    const blocks = Math.ceil(this.times.length / kBlock)
    this.least = new Float32Array(blocks)
    this.most = new Float32Array(blocks)
    this.ways = new Float64Array(blocks)
    for (let b = 0; b < blocks; ++b) {
      let least = Infinity, most = 0, way = 0
      const end = Math.min(this.times.length, (b + 1) * kBlock)
      for (let i = b * kBlock; i < end; ++i) {
        const speed = this.speeds[i]
        if (speed < least) least = speed
        if (speed > most) most = speed
        if (i + 1 < this.times.length) way += speed * (this.times[i + 1] - this.times[i])
      }
      this.least[b] = least
      this.most[b] = most
      this.ways[b] = way
    }
  }
  at(cycle) {
    const i = lastAtMost(this.times, cycle)
    return i < 0 ? 0 : this.speeds[i]
  }
  axisAt(axis, cycle) {
    const { times, speeds } = this.axes[axis]
    const i = lastAtMost(times, cycle)
    return i < 0 ? 0 : speeds[i]
  }
  // [mean, minimum, maximum] between two card clocks.
  between(from, to) {
    const { times, speeds } = this
    const count = times.length
    let i = lastAtMost(times, from)
    let way = 0, least = Infinity, most = 0
    const take = (speed, clocks) => {
      way += speed * clocks
      if (speed < least) least = speed
      if (speed > most) most = speed
    }
    if (i < 0) {
      if (count === 0 || times[0] >= to) return [0, 0, 0]
      take(0, times[0] - from)
      i = 0
    }
    for (let at = Math.max(from, times[i]); at < to && i < count;) {
      if (i % kBlock === 0 && at === times[i]) {
        const b = i / kBlock, end = (b + 1) * kBlock
        if (end < count && times[end] <= to) {
          way += this.ways[b]
          least = Math.min(least, this.least[b])
          most = Math.max(most, this.most[b])
          at = times[end]
          i = end
          continue
        }
      }
      const end = i + 1 < count ? Math.min(to, times[i + 1]) : to
      if (end > at) take(speeds[i], end - at)
      at = end
      ++i
    }
    return [way / (to - from), least === Infinity ? 0 : least, most]
  }
}

// Data of the charts for a stretch of time: two values per column of pixels, its minimum and maximum in the order in
// which they occur.
import { lastAtMost } from './run.js'

// A row of values, one pair per column.
class Envelope {
  constructor(columns) {
    this.values = new Float64Array(2 * columns)
    this.begin(0)
  }
  begin(column) {
    this.column = column
    this.least = Infinity
    this.most = -Infinity
    this.first = this.last = NaN
  }
  put(value) {
    if (this.first !== this.first) this.first = value
    this.last = value
    if (value < this.least) this.least = value
    if (value > this.most) this.most = value
  }
  end() {
    const rising = this.last >= this.first
    this.values[2 * this.column] = rising ? this.least : this.most
    this.values[2 * this.column + 1] = rising ? this.most : this.least
  }
}

// From card clock `from` to `to`: times in seconds; the commanded speed along the path (mm/s); speed, acceleration and
// jerk of each axis; the achieved speed with its range; the override in percent.
export function sample(run, achieved, from, to, columns) {
  const axes = run.axes.length
  const x = new Float64Array(2 * columns)
  const path = new Envelope(columns)
  const rows = ['speed', 'acceleration', 'jerk'].map(() => run.axes.map(() => new Envelope(columns)))
  const ratio = new Envelope(columns)
  const { surroundings } = run
  const apart = surroundings.apart.map(() => new Envelope(columns))
  const mean = new Float64Array(2 * columns), least = new Float64Array(2 * columns), most = new Float64Array(2 * columns)
  const all = [path, ratio, ...rows.flat(), ...apart]
  const width = (to - from) / columns
  const { motion, times, paths } = run

  const rest = () => {
    path.put(0)
    for (const row of rows) for (const envelope of row) envelope.put(0)
  }
  const put = (stretch, clocks) => {
    const p = motion.paths[stretch]
    const share = run.shareAt(stretch, clocks)
    path.put(run.pathSpeed(p, share[1]))
    for (let a = 0; a < axes; ++a) {
      const now = run.axisAt(p, a, share)
      for (let d = 0; d < 3; ++d) rows[d][a].put(now[d + 1])
    }
  }
  // The commanded motion between two places of the motion clock.
  const commanded = (m0, m1) => {
    let s = run.stretchAt(m0)
    if (s < 0) return rest()
    for (; s < motion.count && motion.begins[s] < m1; ++s) {
      const begin = Math.max(m0, motion.begins[s]), end = Math.min(m1, motion.begins[s + 1])
      if (end <= begin) continue
      put(s, begin - motion.begins[s])
      const arc = paths.arcs.get(motion.paths[s])
      if (arc) {
        const a = run.shareAt(s, begin - motion.begins[s])[0], b = run.shareAt(s, end - motion.begins[s])[0]
        const parts = Math.min(24, Math.floor(Math.abs(arc.sweep * (b - a)) / 0.26))
        for (let i = 1; i <= parts; ++i) put(s, begin - motion.begins[s] + (end - begin) * i / (parts + 1))
      }
      put(s, end - motion.begins[s] - 1e-9 * (end - begin))
    }
  }
  for (let column = 0; column < columns; ++column) {
    const t0 = from + column * width, t1 = t0 + width
    x[2 * column] = run.seconds(t0 + width / 4)
    x[2 * column + 1] = run.seconds(t0 + 3 * width / 4)
    for (const envelope of all) envelope.begin(column)
    apart.forEach((envelope, n) => {
      const { times: changes, pulses, pulses_per_mm: scale } = surroundings.apart[n]
      envelope.put(surroundings.apartAt(n, t0))
      for (let i = lastAtMost(changes, t0) + 1; i < changes.length && changes[i] < t1; ++i) envelope.put(pulses[i] / scale)
    })
    // Pieces of the map of times in this column; between two motions all axes are at rest.
    let i = lastAtMost(times.cycles, t0)
    if (i < 0) {
      rest()
      ratio.put(NaN)
      i = 0
    }
    for (; i < times.cycles.length && times.cycles[i] < t1; ++i) {
      const begin = Math.max(t0, times.cycles[i])
      const end = Math.min(t1, times.cycles[i + 1] ?? Infinity)
      if (end <= begin) continue
      if (times.slopes[i] === 0 && !(times.motions[i + 1] > times.motions[i])) {
        rest()
        continue
      }
      const clock = (cycle) => times.motions[i] +
        (cycle - times.cycles[i]) / (times.cycles[i + 1] - times.cycles[i]) * (times.motions[i + 1] - times.motions[i])
      ratio.put(100 * times.slopes[i] / run.fullRatio)
      const m0 = clock(begin), m1 = clock(end)
      if (m1 > m0) commanded(m0, m1)
      else rest()
    }
    const [mid, low, high] = achieved.between(t0, t1)
    mean.fill(mid, 2 * column, 2 * column + 2)
    least.fill(low, 2 * column, 2 * column + 2)
    most.fill(high, 2 * column, 2 * column + 2)
    for (const envelope of all) envelope.end()
  }
  for (let i = 0; i < ratio.values.length; ++i) if (!Number.isFinite(ratio.values[i])) ratio.values[i] = NaN
  return {
    x, path: path.values, mean, least, most, ratio: ratio.values,
    axes: rows.map((row) => row.map((envelope) => envelope.values)), apart: apart.map((envelope) => envelope.values),
  }
}

// All values shown next to the charts, at one clock.
export function readout(run, achieved, cycle) {
  const { motion, ratio } = run.motionAt(cycle)
  const stretch = run.stretchAt(motion)
  const still = ratio === 0 || stretch < 0
  const path = run.pathAt(cycle)
  const share = still ? null : run.shareAt(stretch, motion - run.motion.begins[stretch])
  const of = stretch < 0 ? path : run.motion.paths[stretch]
  const percent = 100 * ratio / run.fullRatio
  return {
    // From the last step of a hold's ramp to the first one after the hold, the slope is slightly above 0.
    path, still, percent: still ? null : run.heldAt(cycle) && percent < 1 ? 0 : percent,
    commanded: still ? 0 : run.pathSpeed(of, share[1]), achieved: achieved.at(cycle),
    axes: run.axes.map((_, a) => still ? [NaN, 0, 0, 0] : run.axisAt(of, a, share)),
    actual: run.axes.map((_, a) => achieved.axisAt(a, cycle)),
    apart: run.surroundings.apart.map((_, n) => run.surroundings.apartAt(n, cycle)),
    positions: run.motors.map((_, motor) => run.positionAt(motor, cycle)),
  }
}

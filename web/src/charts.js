// The charts over time: all share one window of time, and are redrawn from the run when it changes.
import uPlot from 'uplot'
import { make } from './dom.js'
import { axisColour, colour } from './theme.js'
import { drawMark } from './lanes.js'
import { decimals, fixed, number, ticks } from './format.js'

const kFont = '11px system-ui, "Noto Sans", "DejaVu Sans", sans-serif'

// Rows of charts: name, unit, lines.
export function rowsOf(run) {
  const axes = run.axes.map((axis, a) => ({ axis, a })).filter(({ a }) => moves(run, a))
  const units = run.axes.some((axis) => 'ABC'.includes(axis.letter)) ? 'mm or °' : 'mm'
  const kinds = [
    ['speed', 'Axis speed', `${units}/s`, 0, 'max_velocity', 1, true],
    ['acceleration', 'Axis acceleration', `${units}/s²`, 1, 'max_acceleration', 2, true],
    ['jerk', 'Axis jerk', `${units}/s³`, 2, 'max_jerk', 3, run.axes.some((axis) => axis.max_jerk > 0)],
  ]
  return [
    {
      id: 'path', title: 'Path speed', unit: 'mm/s', height: 98, shown: true, least: 0,
      lines: [
        { label: 'achieved', colour: 'achieved', band: true, data: (s) => s.mean, value: (r) => r.achieved },
        { label: 'commanded', colour: 'commanded', data: (s) => s.path, value: (r) => r.commanded },
      ],
    },
    ...kinds.map(([id, title, unit, derivative, limit, at, shown]) => ({
      id, title, unit, of: 'commanded', height: 88, shown,
      limits: [...new Set(axes.map(({ axis }) => axis[limit]).filter((value) => value > 0))],
      lines: axes.map(({ axis, a }) => ({
        label: axis.letter, axis: axis.letter, data: (s) => s.axes[derivative][a], value: (r) => r.axes[a][at],
        actual: derivative === 0 ? (r) => r.actual[a] : undefined, limit: axis[limit],
      })),
    })),
    {
      id: 'override', title: 'Override', unit: '%', height: 64, shown: run.facts.events.length > 0 || run.facts.causes?.length > 0, least: 0, room: 100,
      lines: [{ label: 'in force', colour: 'commanded', data: (s) => s.ratio, value: (r) => r.percent ?? NaN }],
    },
    ...apartRow(run),
  ]
}
// Only with a machine behind the pins; visible from the start if a carriage has lost its place.
function apartRow(run) {
  const { apart, parted } = run.surroundings
  const lines = apart.map((axis, n) => ({ axis, n })).filter(({ axis }) => axis.times.length > 0)
  if (!lines.length) return []
  return [{
    id: 'apart', title: 'Pulses − carriage', unit: 'mm', height: 76, shown: parted.length > 0,
    lines: lines.map(({ axis: { letter }, n }) => ({ label: letter, axis: letter, data: (s) => s.apart[n], value: (r) => r.apart[n] })),
  }]
}
export const turns = (run, motor) => run.steps[motor].count > 0 || run.motors[motor].beside > 0
const moves = (run, axis) => run.kinematics.inverse[axis].some(({ motor }) => turns(run, motor))

export class Chart {
  constructor(row, run) {
    this.row = row
    this.run = run
    this.window = [0, 1]  // seconds
    this.values = row.lines.map(() => make('b'))
    this.plotElement = make('div', { class: 'plot' })
    const named = (value) => `${number(value)} (${row.lines.filter((line) => line.limit === value).map((line) => line.label).join(' ')})`
    const limits = row.limits?.length
      ? make('div', {}, make('em', {}, `limit ${row.limits.length > 1 ? row.limits.map(named).join(', ') : number(row.limits[0])}`)) : null
    this.swatches = row.lines.map(() => make('i'))
    this.element = make('div', { class: 'row', id: `row-${row.id}` },
      make('div', { class: 'label' }, make('h3', {}, row.title, ' ', make('small', {}, row.of ? `${row.unit}, ${row.of}` : row.unit)),
        ...row.lines.map((line, i) => make('div', {}, this.swatches[i], line.label, this.values[i])), limits),
      this.plotElement)
    if (row.id === 'jerk' && !row.limits.length) this.element.querySelector('.label').append(make('div', {}, make('em', {}, 'no limit given')))
  }
  colourOf(line) { return line.axis ? axisColour(line.axis) : colour(line.colour) }
  // Rebuilds everything, because the width or the colours have changed.
  build(width) {
    this.plot?.destroy()
    const { row } = this
    row.lines.forEach((line, i) => { this.swatches[i].style.borderColor = this.colourOf(line) })
    const band = row.lines.some((line) => line.band)
    const series = [{}]
    if (band) {
      const edge = { stroke: 'transparent', points: { show: false }, width: 0 }
      series.push(edge, { ...edge })
    }
    for (const line of row.lines) {
      series.push({ stroke: this.colourOf(line), width: 1.4, points: { show: false }, spanGaps: false })
    }
    this.plot = new uPlot({
      width, height: row.height, padding: [6, 0, 4, 0],
      cursor: { show: false }, select: { show: false }, legend: { show: false },
      scales: { x: { time: false, auto: false, range: () => this.window }, y: { auto: true, range: (_, low, high) => this.rangeOf(low, high) } },
      axes: [
        { show: false },
        {
          size: 52, font: kFont, stroke: colour('faint'), gap: 4,
          grid: { stroke: colour('grid'), width: 1 }, ticks: { show: false },
          splits: (_, __, low, high) => ticks(low, high, Math.max(2, row.height / 16)).list,
          values: (_, list) => this.labels(list),
        },
      ],
      bands: band ? [{ series: [2, 1], fill: alpha(colour('achieved'), 0.28) }] : [],
      series,
      hooks: { drawAxes: [() => this.under()] },
    }, null, this.plotElement)
  }
  labels(list) {
    const most = Math.max(...list.map(Math.abs))
    const [unit, suffix] = most >= 1e6 ? [1e6, 'M'] : most >= 1e4 ? [1e3, 'k'] : [1, '']
    const step = list.length > 1 ? list[1] - list[0] : 1
    return list.map((value) => value === 0 ? '0' : fixed(value / unit, decimals(step / unit)) + suffix)
  }
  rangeOf(low, high) {
    const { row } = this
    if (!Number.isFinite(low)) return [0, 1]
    if (row.least === 0) {
      const most = Math.max(high, row.room ?? 0)
      return [0, most > 0 ? most * 1.12 : 1]
    }
    // The range is symmetric around zero; a limit is shown if the motion comes near it.
    let most = Math.max(Math.abs(low), Math.abs(high))
    for (const limit of row.limits ?? []) if (limit > most && limit < 1.6 * most) most = limit
    return most > 0 ? [-1.15 * most, 1.15 * most] : [-1, 1]
  }
  // Limits and pauses, above the grid and below the lines.
  under() {
    const { plot, row, run } = this
    const { ctx, bbox } = plot
    ctx.save()
    ctx.beginPath()
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height)
    ctx.clip()
    ctx.fillStyle = alpha(colour('faint'), 0.12)
    for (const [from, to] of run.gaps) {
      const a = plot.valToPos(run.seconds(from), 'x', true), b = plot.valToPos(run.seconds(to), 'x', true)
      if (b > bbox.left && a < bbox.left + bbox.width && b - a > 1) ctx.fillRect(a, bbox.top, b - a, bbox.height)
    }
    for (const mark of run.surroundings.marks) {
      const at = plot.valToPos(run.seconds(mark.cycle), 'x', true)
      if (at >= bbox.left && at <= bbox.left + bbox.width) drawMark(ctx, mark, at, bbox.top, bbox.height)
    }
    ctx.setLineDash([6, 4])
    ctx.lineWidth = 1
    for (const limit of new Set(row.limits ?? [])) {
      const owners = row.lines.filter((line) => line.limit === limit)
      ctx.strokeStyle = owners.length === 1 ? this.colourOf(owners[0]) : colour('faint')
      for (const value of [limit, -limit]) {
        const y = Math.round(plot.valToPos(value, 'y', true)) + 0.5
        ctx.beginPath()
        ctx.moveTo(bbox.left, y)
        ctx.lineTo(bbox.left + bbox.width, y)
        ctx.stroke()
      }
    }
    ctx.restore()
  }
  draw(samples, window) {
    this.window = window
    const data = [samples.x]
    if (this.row.lines.some((line) => line.band)) data.push(samples.least, samples.most)
    for (const line of this.row.lines) data.push(line.data(samples))
    this.plot.setData(data.map((values) => Array.from(values, (v) => v !== v ? null : v)), false)
    this.plot.batch(() => {
      this.plot.setScale('x', { min: window[0], max: window[1] })
      let low = Infinity, high = -Infinity
      for (const values of data.slice(1)) for (const v of values) {
        if (v < low) low = v
        if (v > high) high = v
      }
      const [min, max] = this.rangeOf(low, high)
      this.plot.setScale('y', { min, max })
    })
  }
  read(now) {
    this.row.lines.forEach((line, i) => {
      const value = number(line.value(now))
      this.values[i].textContent = line.actual ? `${value}, actual ${number(line.actual(now))}` : value
    })
  }
}

export function alpha(hex, share) {
  const value = parseInt(hex.slice(1), 16)
  return `rgba(${value >> 16 & 255}, ${value >> 8 & 255}, ${value & 255}, ${share})`
}

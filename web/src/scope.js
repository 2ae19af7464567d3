// STEP and DIR pins as on an oscilloscope: single pulses if they are far enough apart, otherwise their density.
import { contextOf, make, sizeCanvas } from './dom.js'
import { axisColour, colour } from './theme.js'
import { alpha, turns } from './charts.js'
import { drawMark } from './lanes.js'
import { lastAtMost } from './run.js'

const kRow = 19

export class Scope {
  constructor(run) {
    this.run = run
    this.motors = run.motors.map((motor, m) => m).filter((m) => turns(run, m))
    this.canvas = make('canvas')
    this.values = this.motors.map(() => make('b'))
    this.swatches = this.motors.map(() => make('i'))
    this.element = make('div', { class: 'row', id: 'row-pins' },
      make('div', { class: 'label' }, make('h3', {}, 'Pins ', make('small', {}, 'pulse counts')),
        ...this.motors.map((m, i) => make('div', {}, this.swatches[i], run.kinematics.names[m], this.values[i]))),
      make('div', { class: 'plot' }, this.canvas))
    this.turns = run.motors.map((_, m) => turnsOf(run, m))
    this.height = 12 + 2 * kRow * Math.max(1, this.motors.length)
  }
  build(width) {
    this.width = width
    sizeCanvas(this.canvas, width, this.height)
    this.motors.forEach((m, i) => { this.swatches[i].style.borderColor = axisColour(this.run.motors[m].letter) })
  }
  read(now) {
    this.motors.forEach((m, i) => { this.values[i].textContent = now.positions[m] })
  }
  // From and to: card clocks. The plot begins `left` pixels from the canvas's edge.
  draw(from, to, left) {
    const context = contextOf(this.canvas, this.width)
    context.clearRect(0, 0, this.width, this.height)
    this.view = { from, scale: (this.width - left) / (to - from), left, to }
    context.font = '10px system-ui, "Noto Sans", "DejaVu Sans", sans-serif'
    context.textAlign = 'right'
    context.textBaseline = 'middle'
    this.motors.forEach((m, i) => {
      const top = 6 + 2 * kRow * i
      context.fillStyle = colour('faint')
      context.fillText('STEP', left - 6, top + kRow / 2)
      context.fillText('DIR', left - 6, top + 1.5 * kRow)
      context.save()
      context.beginPath()
      context.rect(left, 0, this.width - left, this.height)
      context.clip()
      this.drawSteps(context, m, top + 3, kRow - 6)
      this.drawDirection(context, m, top + kRow + 3, kRow - 6)
      context.restore()
    })
    for (const mark of this.run.surroundings.marks) {
      if (mark.cycle < from || mark.cycle > to) continue
      drawMark(context, mark, left + (mark.cycle - from) * this.view.scale, 0, this.height)
    }
  }
  drawSteps(context, m, top, height) {
    const { pins, count } = this.run.steps[m]
    const { from, to, scale, left } = this.view
    const length = Math.max(1, this.run.motors[m].step_length)
    const ink = axisColour(this.run.motors[m].letter)
    const x = (cycle) => left + (cycle - from) * scale
    const first = Math.max(0, lastAtMost(pins, from - length)), end = lastAtMost(pins, to) + 1
    context.strokeStyle = ink
    context.lineWidth = 1.2
    if (end - first < 4 * (this.width - left)) {
      // A pulse is drawn with its width in pixels; one narrower than a pixel is a line.
      context.beginPath()
      context.moveTo(left, top + height)
      for (let i = first; i < Math.min(end, count); ++i) {
        const a = x(pins[i]), b = x(pins[i] + length)
        context.lineTo(a, top + height)
        context.lineTo(a, top)
        context.lineTo(b, top)
        context.lineTo(b, top + height)
      }
      context.lineTo(this.width, top + height)
      context.stroke()
      return
    }
    // Relative to the densest column.
    const columns = Math.floor(this.width - left)
    const counts = new Float64Array(columns)
    let before = first
    for (let c = 0; c < columns; ++c) {
      const next = lastAtMost(pins, from + (c + 1) / scale) + 1
      counts[c] = next - before
      before = next
    }
    const most = Math.max(...counts, 1)
    for (let c = 0; c < columns; ++c) {
      if (counts[c] === 0) continue
      context.fillStyle = alpha(ink, 0.35 + 0.65 * counts[c] / most)
      context.fillRect(left + c, top, 1, height)
    }
    context.strokeStyle = alpha(ink, 0.5)
    context.beginPath()
    context.moveTo(left, top + height)
    context.lineTo(this.width, top + height)
    context.stroke()
  }
  drawDirection(context, m, top, height) {
    const { times, levels } = this.turns[m]
    const { from, to, scale, left } = this.view
    const y = (level) => level ? top : top + height
    const first = lastAtMost(times, from)
    let level = first < 0 ? (this.run.motors[m].inverted ? 1 : 0) : levels[first]
    context.strokeStyle = axisColour(this.run.motors[m].letter)
    context.lineWidth = 1.2
    context.beginPath()
    context.moveTo(left, y(level))
    for (let i = first + 1; i < times.length && times[i] <= to; ++i) {
      const x = left + (times[i] - from) * scale
      context.lineTo(x, y(level))
      level = levels[i]
      context.lineTo(x, y(level))
    }
    context.lineTo(this.width, y(level))
    context.stroke()
  }
}

// Clocks at which DIR changes, and its level from then on: 1 is negative unless the machine inverts it.
export function turnsOf(run, m) {
  const { pins, positions, count } = run.steps[m]
  const { dir_lead: lead, inverted, start, before } = run.motors[m]
  const times = [], levels = []
  let back = 0
  for (let i = 0; i < count; ++i) {
    const now = positions[i] < (i > 0 ? positions[i - 1] : start + before) ? 1 : 0
    if (now === back) continue
    back = now
    times.push(pins[i] - lead)
    levels.push(back ^ (inverted ? 1 : 0))
  }
  return { times: Float64Array.from(times), levels: Uint8Array.from(levels) }
}

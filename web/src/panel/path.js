// The path of the tool so far, seen along an axis of the machine.
import { contextOf, make, sizeCanvas } from '../dom.js'
import { ticks } from '../format.js'
import { colour } from '../theme.js'

const kMost = 40000  // points; above that, every second point of the older half is dropped
const kViews = { Top: ['X', 'Y'], Front: ['X', 'Z'], Side: ['Y', 'Z'] }

export class Path {
  constructor(canvas, buttons, axes) {
    this.canvas = canvas
    this.index = Object.fromEntries(axes.map(({ letter }, n) => [letter, n]))
    this.points = []
    this.axes = null
    const names = Object.keys(kViews).filter((name) => kViews[name].every((letter) => letter in this.index))
    const choose = (name) => {
      this.view = kViews[name]
      for (const button of buttons.children) button.setAttribute('aria-pressed', String(button.textContent === name))
      this.draw()
    }
    buttons.replaceChildren(
      ...names.map((name) => make('button', { type: 'button', onclick: () => choose(name) }, name)),
      make('button', { type: 'button', onclick: () => { this.points = []; this.draw() } }, 'Clear'))
    this.view = null
    if (names.length) choose(names[0])
    new ResizeObserver(() => this.draw()).observe(canvas.parentElement)
  }
  add(axes) {
    const first = !this.axes
    this.axes = axes
    const point = axes.map(({ machine }) => machine)
    const last = this.points.at(-1)
    if (last && last.every((value, n) => value === point[n])) return first && this.draw()
    this.points.push(point)
    if (this.points.length > kMost) this.points = this.points.filter((_, n) => n > kMost / 2 || n % 2 === 0)
    this.draw()
  }
  draw() {
    if (!this.frame) this.frame = requestAnimationFrame(() => { this.frame = 0; this.paint() })
  }
  // Bounds of the view for the two axes: path, tool, and soft limits that are near.
  box([a, b]) {
    const ends = [a, b].map((n) => {
      const { machine, work } = this.axes[n]
      let low = Math.min(machine, machine - work), high = Math.max(machine, machine - work)
      for (const point of this.points) {
        low = Math.min(low, point[n])
        high = Math.max(high, point[n])
      }
      return [low, high]
    })
    const size = Math.max(ends[0][1] - ends[0][0], ends[1][1] - ends[1][0], 10) * 1.15
    return ends.map(([low, high]) => [(low + high - size) / 2, size])
  }
  paint() {
    const { canvas } = this
    const width = canvas.parentElement.clientWidth - 28, height = canvas.clientHeight
    if (!this.view || !this.axes || width < 50) return
    sizeCanvas(canvas, width, height)
    const context = contextOf(canvas, width)
    const pair = this.view.map((letter) => this.index[letter])
    const [[left, size], [bottom]] = this.box(pair)
    const scale = Math.min(width, height) / size
    const x = (value) => width / 2 + (value - left - size / 2) * scale
    const y = (value) => height / 2 - (value - bottom - size / 2) * scale
    this.grid(context, { width, height, scale, x, y, middle: [left + size / 2, bottom + size / 2] })
    this.limits(context, pair, x, y)
    context.strokeStyle = colour('executed')
    context.lineWidth = 1.5
    context.lineJoin = 'round'
    context.beginPath()
    for (const [n, point] of this.points.entries()) context[n ? 'lineTo' : 'moveTo'](x(point[pair[0]]), y(point[pair[1]]))
    context.stroke()
    const [zero, tool] = ['zero', 'tool'].map((what) => pair.map((n) => this.axes[n].machine - (what === 'zero' ? this.axes[n].work : 0)))
    this.cross(context, x(zero[0]), y(zero[1]))
    context.fillStyle = colour('cursor')
    context.beginPath()
    context.arc(x(tool[0]), y(tool[1]), 5, 0, 2 * Math.PI)
    context.fill()
  }
  grid(context, { width, height, scale, x, y, middle }) {
    context.lineWidth = 1
    context.font = '11px system-ui, sans-serif'
    const [across, up] = [width, height].map((length, n) => ticks(middle[n] - length / 2 / scale, middle[n] + length / 2 / scale, 6 * length / Math.min(width, height)).list)
    context.strokeStyle = colour('grid')
    context.beginPath()
    for (const value of across) { context.moveTo(x(value), 0); context.lineTo(x(value), height) }
    for (const value of up) { context.moveTo(0, y(value)); context.lineTo(width, y(value)) }
    context.stroke()
    context.fillStyle = colour('faint')
    const text = (value) => `${Number(value.toFixed(6))}`
    for (const value of across.slice(1)) context.fillText(text(value), x(value) + 3, height - 4)
    for (const value of up.slice(1)) context.fillText(text(value), 3, y(value) - 3)
    context.fillText(`machine coordinates, mm; ${this.view[0]} to the right, ${this.view[1]} upwards`, 3, 12)
  }
  limits(context, [a, b], x, y) {
    const [h, v] = [this.axes[a], this.axes[b]]
    if ([h.min, h.max, v.min, v.max].some((end) => end === null)) return
    context.strokeStyle = colour('x')
    context.setLineDash([5, 4])
    context.strokeRect(x(h.min), y(v.max), x(h.max) - x(h.min), y(v.min) - y(v.max))
    context.setLineDash([])
  }
  // Work zero.
  cross(context, x, y) {
    context.strokeStyle = colour('accent')
    context.lineWidth = 1.5
    context.beginPath()
    context.moveTo(x - 9, y)
    context.lineTo(x + 9, y)
    context.moveTo(x, y - 9)
    context.lineTo(x, y + 9)
    context.arc(x, y, 5, 0, 2 * Math.PI)
    context.stroke()
  }
}

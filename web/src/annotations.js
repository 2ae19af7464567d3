// Labels over the path: numbers at the grid, start and end, the scale, and the directions of the axes.
import { Vector3 } from 'three'
import { Labels } from './labels.js'
import { axisColour, colour } from './theme.js'
import { decimals, fixed, niceStep } from './format.js'

const kLine = 13     // height of a label, pixels
const kBeside = 9    // from the middle of a mark to its label
const kAxes = [42, 40]  // origin of the axes symbol: from the left, from the bottom

export class Annotations {
  constructor(view) {
    this.view = view
    this.canvas = document.createElement('canvas')
  }
  resize(width, height, ratio) {
    Object.assign(this, { width, height, ratio })
    Object.assign(this.canvas, { width: width * ratio, height: height * ratio })
    Object.assign(this.canvas.style, { width: `${width}px`, height: `${height}px` })
  }
  draw() {
    const { width, height, ratio } = this
    this.context = this.canvas.getContext('2d')
    this.context.setTransform(ratio, 0, 0, ratio, 0, 0)
    this.context.clearRect(0, 0, width, height)
    this.context.font = '11px system-ui, "Noto Sans", "DejaVu Sans", sans-serif'
    this.context.textAlign = 'left'
    this.context.textBaseline = 'middle'
    this.labels = new Labels(width, height)
    this.takeOver()
    this.drawScale()
    this.drawAxes()
    const sides = this.view.grid.lines.visible ? this.numbersOfGrid() : []
    this.markEnds(sides.flat().map(({ text, x, y }) => this.boxOf(text, x, y)))
    for (const numbers of sides) this.writeNumbers(numbers)
  }
  takeOver() {
    const own = this.canvas.getBoundingClientRect()
    for (const other of this.view.over) {
      const { left, top, right, bottom } = other.getBoundingClientRect()
      this.labels.take([left - own.left, top - own.top, right - own.left, bottom - own.top])
    }
  }
  // The box of a text with this centre.
  boxOf(text, x, y) {
    const half = this.context.measureText(text).width / 2
    return [x - half - 1, y - kLine / 2, x + half + 1, y + kLine / 2]
  }
  write(text, box, ink, y = (box[1] + box[3]) / 2) {
    this.context.fillStyle = colour(ink)
    this.context.fillText(text, box[0] + 1, y)
  }
  // The place on the canvas of a point of the path (mm from the run's middle).
  at(x, y, z) {
    const p = new Vector3(x, y, z).project(this.view.camera)
    return [(p.x + 1) / 2 * this.width, (1 - p.y) / 2 * this.height]
  }
  // Starts with the last one: the first label written has the unit.
  writeNumbers(numbers) {
    let unit = ' mm'
    for (const { text, x, y } of numbers) {
      const box = this.labels.place([this.boxOf(text + unit, x, y)])
      if (!box) continue
      this.write(text + unit, box, 'faint')
      unit = ''
    }
  }
  // Texts with their places, beginning with the last one of each side.
  numbersOfGrid() {
    const { step: gridStep, x, y, z } = this.view.grid.ruled
    const { centre } = this.view.run
    const { size, box } = this.view
    const at = (px, py, pz) => this.at(px - centre[0], py - centre[1], pz - centre[2])
    const sides = []
    const rule = (range, place, outward, step = gridStep) => {
      const digits = decimals(step)
      const p = place(range.low), q = place(range.high)
      const gap = Math.hypot(q[0] - p[0], q[1] - p[1]) / Math.max(1, range.count)
      if (!(gap > 3)) return
      const every = Math.max(1, Math.ceil(34 / gap))
      const numbers = []
      for (let i = range.count; i >= 0; --i) {
        const value = range.low + i * step
        if (every > 1 && Math.round(value / step) % every !== 0) continue
        const [px, py] = place(value)
        numbers.push({ text: fixed(value, digits), x: px + outward[0], y: py + outward[1] })
      }
      sides.push(numbers)
    }
    // Away from the grid; below it if the grid is seen edge-on.
    const towards = (from, to) => {
      const d = [from[0] - to[0], from[1] - to[1]], length = Math.hypot(...d)
      return length < 1 ? [0, 12] : [d[0] / length * 15, d[1] / length * 12]
    }
    const ground = z + centre[2]
    const xs = (v) => at(v, y.low, ground)
    const ys = (v) => at(x.low, v, ground)
    const xMiddle = (x.low + x.high) / 2, yMiddle = (y.low + y.high) / 2
    if (size[0] > 0) rule(x, xs, towards(xs(xMiddle), at(xMiddle, y.high, ground)))
    if (size[1] > 0) rule(y, ys, towards(ys(yMiddle), at(x.high, yMiddle, ground)))
    // Heights, if they matter: at the leftmost corner.
    if (size[2] < 0.25 * Math.max(size[0], size[1])) return sides
    const corners = size[0] + size[1] > 0 ? [[x.low, y.low], [x.low, y.high], [x.high, y.low], [x.high, y.high]] : [centre]
    const left = corners.reduce((p, q) => at(q[0], q[1], ground)[0] < at(p[0], p[1], ground)[0] ? q : p)
    const step = niceStep(size[2] / 8)
    const low = Math.ceil((box.low[2] + centre[2]) / step - 1e-6) * step
    const count = Math.floor(size[2] / step + 1e-6)
    rule({ low, count, high: low + count * step }, (v) => at(left[0], left[1], v), [-26, 0], step)
    return sides
  }
  // Labels of start and end, at a place that covers no numbers, if there is one.
  markEnds(numbers) {
    const { run } = this.view
    if (run.paths.count === 0) return
    const place = (mm) => this.at(...run.space.map((axis, i) => axis < 0 ? 0 : mm(axis) - run.centre[i]))
    const begin = place((axis) => run.startCoordinate(axis))
    const end = place((axis) => run.axisTo(run.paths.count - 1, axis))
    const same = Math.hypot(begin[0] - end[0], begin[1] - end[1]) < 12
    const marks = same ? [[begin, 'start and end']] : [[end, 'end'], [begin, 'start']]
    for (const [[x, y]] of marks) {
      this.drawMark(x, y)
      this.labels.take([x - 5, y - 5, x + 5, y + 5])
    }
    for (const [[x, y], text] of marks) {
      const half = this.context.measureText(text).width / 2, aside = half + kBeside
      const places = [[aside, -10], [aside, 11], [-aside, -10], [-aside, 11], [aside, 0], [-aside, 0], [0, -15], [0, 16]]
      const box = this.labels.place(places.map(([dx, dy]) => this.boxOf(text, x + dx, y + dy)), numbers)
      if (box) this.writeOnPanel(text, box)
    }
  }
  drawMark(x, y) {
    const { context } = this
    context.lineWidth = 1.6
    context.strokeStyle = colour('ink')
    context.fillStyle = colour('panel')
    context.beginPath()
    context.arc(x, y, 4, 0, 7)
    context.fill()
    context.stroke()
  }
  // With a rim in the background colour, to be readable over lines.
  writeOnPanel(text, box, ink = colour('ink'), y = (box[1] + box[3]) / 2) {
    this.context.lineWidth = 3
    this.context.strokeStyle = colour('panel')
    this.context.strokeText(text, box[0] + 1, y)
    this.context.fillStyle = ink
    this.context.fillText(text, box[0] + 1, y)
  }
  drawScale() {
    const { context } = this
    const { camera, pulse } = this.view
    const step = niceStep(70 / camera.zoom)
    const length = step * camera.zoom
    const x = 92, y = this.height - 20
    context.strokeStyle = colour('ink')
    context.lineWidth = 1.2
    context.beginPath()
    context.moveTo(x, y - 4); context.lineTo(x, y); context.lineTo(x + length, y); context.lineTo(x + length, y - 4)
    context.stroke()
    const distance = step >= 1 ? `${fixed(step, 0)} mm` : step >= 1e-3 ? `${fixed(step, decimals(step))} mm` : `${fixed(step * 1e3, decimals(step * 1e3))} µm`
    const pulses = step / pulse
    const text = pulses < 1e4 ? `${distance} = ${fixed(pulses, pulses < 10 ? 1 : 0)} pulses` : distance
    const box = [x - 1, y - 5 - kLine, x + Math.max(length, context.measureText(text).width) + 1, y + 1]
    this.labels.take(box)
    this.writeOnPanel(text, box, colour('ink'), y - 5 - kLine / 2)
  }
  drawAxes() {
    const { context } = this
    const { camera, run } = this.view
    const origin = [kAxes[0], this.height - kAxes[1]]
    const matrix = camera.matrixWorldInverse.elements
    const arms = run.space.map((axis, i) => ({ letter: 'XYZ'[i], axis, x: matrix[4 * i] * 26, y: -matrix[4 * i + 1] * 26, depth: matrix[4 * i + 2] }))
    for (const arm of arms.sort((p, q) => p.depth - q.depth)) {
      if (arm.axis < 0) continue
      const length = Math.hypot(arm.x, arm.y)
      context.strokeStyle = context.fillStyle = axisColour(arm.letter)
      context.lineWidth = 2
      context.beginPath()
      context.moveTo(...origin)
      context.lineTo(origin[0] + arm.x, origin[1] + arm.y)
      context.stroke()
      if (length < 6) continue
      const box = this.boxOf(arm.letter, origin[0] + arm.x * (1 + 9 / length), origin[1] + arm.y * (1 + 9 / length))
      this.writeOnPanel(arm.letter, box, axisColour(arm.letter))
    }
    this.labels.take([origin[0] - 40, origin[1] - 40, origin[0] + 40, origin[1] + 40])
  }
}

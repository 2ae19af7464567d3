// The card's inputs as a strip: one lane per input, filled while it is active, with an edge at each change; above them,
// the names of the causes that held or stopped the run.
import { contextOf, make, sizeCanvas } from './dom.js'
import { colour } from './theme.js'
import { alpha } from './charts.js'
import { fixed } from './format.js'
import { lastAtMost } from './run.js'
import { activeAt, placeText } from './surroundings.js'

const kLane = 16    // pixels, as a line of the label next to it
const kTitle = 24   // above the first lane, as the title next to it: a line of names
const kMore = 15    // a second line, if a run has several
const kFont = '11px system-ui, "Noto Sans", "DejaVu Sans", sans-serif'

export class Lanes {
  constructor(run) {
    this.run = run
    const { lanes } = run.surroundings
    // The inputs that change; all inputs if none does.
    const moving = lanes.filter(({ times }) => times.length > 0)
    this.lanes = moving.length ? moving : lanes
    this.values = this.lanes.map(() => make('b'))
    this.canvas = make('canvas')
    const still = lanes.length - this.lanes.length
    this.element = make('div', { class: 'row', id: 'row-inputs' },
      make('div', { class: 'label' },
        make('h3', {}, 'Inputs ', make('small', {}, still ? `${still} more do not change` : 'by role')),
        ...this.lanes.map((lane, i) => make('div', { title: `${lane.name} (${lane.detail})` }, make('span', { class: 'name' }, lane.name), this.values[i]))),
      make('div', { class: 'plot' }, this.canvas))
    this.rows = run.surroundings.marks.length > 1 ? 2 : 1
    this.names = kTitle + (this.rows - 1) * kMore
    this.element.querySelector('h3').style.marginBottom = `${2 + (this.rows - 1) * kMore}px`
    this.height = this.names + kLane * this.lanes.length + 5
  }
  build(width) {
    this.width = width
    sizeCanvas(this.canvas, width, this.height)
  }
  read(cycle) {
    this.lanes.forEach((lane, i) => { this.values[i].textContent = activeAt(lane, cycle) ? 'active' : '–' })
  }
  // From and to: card clocks. The plot begins `left` pixels from the canvas's edge.
  draw(from, to, left) {
    const context = contextOf(this.canvas, this.width)
    context.clearRect(0, 0, this.width, this.height)
    this.view = { from, to, left, x: (cycle) => left + (cycle - from) / (to - from) * (this.width - left) }
    context.save()
    context.beginPath()
    context.rect(left, 0, this.width - left, this.height)
    context.clip()
    this.lanes.forEach((lane, i) => this.drawLane(context, lane, this.names + kLane * i + 2, kLane - 5))
    context.restore()
    this.drawMarks(context)
  }
  drawLane(context, lane, top, height) {
    const { from, to, left, x } = this.view
    const first = lastAtMost(lane.times, from)
    context.fillStyle = colour('grid')
    context.fillRect(left, top + height - 1, this.width - left, 1)
    let since = left, active = first < 0 ? lane.begin : lane.states[first]
    const fill = (end) => {
      if (!active) return
      context.fillStyle = alpha(colour('achieved'), 0.55)
      context.fillRect(since, top, Math.max(1, end - since), height)
    }
    for (let i = first + 1; i < lane.times.length && lane.times[i] <= to; ++i) {
      const at = x(lane.times[i])
      fill(at)
      since = at
      active = lane.states[i]
      context.fillStyle = colour('ink')
      context.fillRect(at - 0.5, top, 1, height)
    }
    fill(this.width)
  }
  // Puts each name next to its mark, not over another one, then extends it as far as there is room.
  drawMarks(context) {
    const { from, to, left, x } = this.view
    context.font = kFont
    context.textBaseline = 'middle'
    context.textAlign = 'left'
    const marks = this.run.surroundings.marks.filter(({ cycle }) => cycle >= from && cycle <= to).map((mark) => ({ mark, at: x(mark.cycle) }))
    const write = (one, text) => {
      const width = context.measureText(text).width
      const free = (begin) => begin >= left && begin + width <= this.width &&
        marks.every((other) => other === one || other.row !== row || begin + width + 8 < other.box[0] || begin > other.box[1] + 8)
      let row = one.row ?? 0
      for (; row < this.rows; ++row) {
        const begin = [one.at + 5, one.at - 5 - width].find(free)
        if (begin !== undefined) return Object.assign(one, { text, row, box: [begin, begin + width] })
      }
    }
    const texts = marks.map(({ mark }) => textsOf(this.run, mark))
    for (let size = 0; size < kSizes; ++size) marks.forEach((one, i) => write(one, texts[i][size]))
    for (const { mark, at } of marks) drawMark(context, mark, at, 0, this.height)
    for (const { mark, text, row, box } of marks) {
      if (!text) continue
      context.fillStyle = markColour(mark)
      context.fillText(text, box[0], kTitle / 2 + row * kMore)
    }
    this.named = marks.filter(({ text }) => text).map(({ text }) => text)
  }
}

export const markColour = (mark) => colour(mark.parting ? 'e' : 'cursor')

// A line in a chart at each hold or stop of the run.
export function drawMark(context, mark, at, top, height) {
  context.save()
  context.strokeStyle = markColour(mark)
  context.lineWidth = 1.2
  context.setLineDash([4, 3])
  context.beginPath()
  context.moveTo(at, top)
  context.lineTo(at, top + height)
  context.stroke()
  context.restore()
}

// Short and longer texts for it; kSizes texts.
const kSizes = 4
function textsOf(run, mark) {
  const { name, reaction, cycle, line, place } = mark
  const what = reaction && reaction !== name ? `${name}: ${reaction}` : name
  const when = `${fixed(run.seconds(cycle), 4)} s`
  return [name, what, `${what} · ${when}`, `${what} · ${when} · ${placeText(run, place)} mm · line ${line}`]
}

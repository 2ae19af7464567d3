// The page of a run: tool path, program, charts over time, one cursor.
import { readStreams } from './streams.js'
import { lastAtMost, Run } from './run.js'
import { Achieved } from './achieved.js'
import { readout, sample } from './samples.js'
import { coloured, View } from './view.js'
import { Chart, rowsOf } from './charts.js'
import { Lanes } from './lanes.js'
import { Scope } from './scope.js'
import { Program } from './program.js'
import { fillSummary, totalsOf } from './summary.js'
import { byId, contextOf, make, sizeCanvas } from './dom.js'
import { colour, isDark, rampCss, setTheme } from './theme.js'
import { decimals, duration, fixed, grouped, millimetres, number, ticks } from './format.js'

const kScale = 52     // pixels for the numbers to the left of the charts
const kLeast = 24     // clocks in the closest view

class Page {
  constructor(run) {
    this.run = run
    this.achieved = new Achieved(run)
    this.cycle = 0
    this.window = [0, run.cycles]
    this.head()
    this.charts = rowsOf(run).map((row) => new Chart(row, run))
    this.scope = new Scope(run)
    this.lanes = new Lanes(run)
    this.program = new Program(byId('program'), run, (line) => this.goToLine(line))
    fillSummary(byId('summary'), run, (line) => this.goToLine(line), (cycle) => this.setCycle(cycle, true))
    this.view = new View(byId('view'), run, ['tools', 'legend', 'place'].map(byId))
    this.buildTools()
    this.buildRows()
    this.buildBar()
    this.listen()
    this.tabs()
    this.legend()
    const first = run.executed.count ? run.executed.times[0] : 0
    this.setCycle(Math.min(run.cycles, Math.max(first, run.cycles * 0.32)))
  }

  // ---- head, tools, tabs

  head() {
    const { run } = this
    const name = run.facts.program.split('/').at(-1)
    byId('title').textContent = name
    byId('title').title = run.facts.program
    document.title = `${name} – Trammel`
    const totals = totalsOf(run)
    const say = (label, text) => byId('numbers').append(make('li', {}, make('span', {}, label), make('b', {}, text)))
    say('time', duration(run.seconds(run.cycles)))
    say('feed', millimetres(totals.feed))
    say('rapids', millimetres(totals.rapid))
    say('pulses', grouped(run.facts.steps.reduce((a, b) => a + b, 0)))
    say('stops', grouped(totals.stops))
    const { line, arc } = run.facts.max_deviation
    say('largest deviation', `${fixed(Math.max(line, arc), 3)} pulses`)
  }
  buildTools() {
    const tools = byId('tools')
    const group = (...buttons) => tools.append(make('div', { class: 'group' }, ...buttons))
    const button = (text, title, act) => make('button', { title, onclick: act }, text)
    group(
      button('Fit', 'All of the path (F)', () => this.view.fit()),
      button('3-D', 'From above and aside (1)', () => this.view.look('iso')),
      button('Top', 'X Y from above (2)', () => this.view.look('top')),
      button('Front', 'X Z from the front (3)', () => this.view.look('front')),
      button('Side', 'Y Z from the side (4)', () => this.view.look('side')),
      button('Pulses', 'The tool, so close that single pulses show (P)', () => this.view.close()))
    this.modes = Object.entries(coloured).map(([mode, { label }]) => {
      const one = button(label, `Colour by ${label.toLowerCase()} (C)`, () => this.setMode(mode))
      one.dataset.mode = mode
      return one
    })
    group(...this.modes)
    const toggles = [['rapid', 'Rapids', 'R'], ['executed', 'Executed', 'E'], ['grid', 'Grid', 'G']].map(([what, text, key]) => {
      const one = button(text, `Show or hide (${key})`, () => {
        this.view.show(what, !this.view.isShown(what))
        one.setAttribute('aria-pressed', this.view.isShown(what))
      })
      one.setAttribute('aria-pressed', 'true')
      one.dataset.show = what
      return one
    })
    group(...toggles)
    this.setMode('speed')
  }
  setMode(mode) {
    this.view.setMode(mode)
    for (const one of this.modes) one.setAttribute('aria-pressed', one.dataset.mode === mode)
    this.legend()
  }
  legend() {
    const { unit } = coloured[this.view.mode]
    const most = this.view.scaleOf(this.view.mode)
    const ends = this.view.mode === 'load' ? ['0', `${number(100 * most)}`] : ['0', number(most)]
    const key = (name, text, style) => make('div', { class: 'key' }, make('i', { style: `border-color: ${colour(name)}; border-top-style: ${style}` }), text)
    byId('legend').replaceChildren(
      make('div', { class: 'ramp', style: `background: ${rampCss()}` }),
      make('div', { class: 'ends' }, make('span', {}, ends[0]), make('span', {}, unit), make('span', {}, ends[1])),
      key('rapid', 'rapid', 'dashed'), key('executed', 'executed, pulse by pulse', 'solid'))
  }
  tabs() {
    for (const name of ['program', 'summary']) {
      byId(`tab-${name}`).addEventListener('click', () => this.openTab(name))
    }
  }
  openTab(name) {
    for (const other of ['program', 'summary']) {
      byId(`tab-${other}`).setAttribute('aria-selected', other === name)
      byId(other).hidden = other !== name
    }
    if (name === 'program') this.program.show()
  }

  // ---- the charts

  buildRows() {
    const rows = byId('rows')
    for (const chart of this.charts) {
      rows.append(chart.element)
      chart.element.hidden = !chart.row.shown
    }
    // Below the speed, for comparison.
    this.charts[0].element.after(this.lanes.element)
    this.lanes.element.hidden = !this.run.surroundings.busy
    rows.append(this.scope.element)
    this.axis = make('canvas')
    rows.append(make('div', { class: 'row', id: 'axis' }, make('div', { class: 'label' }, 's'), make('div', { class: 'plot' }, this.axis)))
    new ResizeObserver(() => this.resizeCharts()).observe(byId('charts'))
  }
  buildBar() {
    const group = (...buttons) => make('div', { class: 'group' }, ...buttons)
    const button = (text, title, act) => make('button', { title, onclick: act }, text)
    byId('zoom').append(group(
      button('Whole run', 'All of the time (0)', () => this.setWindow(0, this.run.cycles)),
      button('−', 'More time (-)', () => this.zoomTime(2)),
      button('+', 'Less time (+)', () => this.zoomTime(0.5)),
      button('Clocks', 'Single clocks at the cursor (K)', () => this.closeTime())))
    const all = [...this.charts.map((chart) => [chart.row.title, chart.element]), ['Pins', this.scope.element]]
    const { surroundings } = this.run
    if (surroundings.lanes.length || surroundings.marks.length) all.splice(1, 0, ['Inputs', this.lanes.element])
    byId('shown').append(group(...all.map(([title, element]) => {
      const one = button(title.replace('Axis ', '').replace(/^./, (c) => c.toUpperCase()), `Show or hide: ${title}`, () => {
        element.hidden = !element.hidden
        one.setAttribute('aria-pressed', !element.hidden)
        this.resizeCharts()
      })
      one.setAttribute('aria-pressed', !element.hidden)
      return one
    })))
  }
  plotWidth() { return Math.max(60, this.axis.parentElement.clientWidth) }
  resizeCharts() {
    const width = this.plotWidth()
    if (width === this.width && this.builtTheme === isDark()) return this.drawCharts()
    this.width = width
    this.builtTheme = isDark()
    for (const chart of this.charts) chart.build(width)
    this.scope.build(width)
    this.lanes.build(width)
    this.drawCharts()
  }
  drawCharts() {
    if (this.chartFrame) return
    this.chartFrame = requestAnimationFrame(() => { this.chartFrame = 0; this.drawChartsNow() })
  }
  drawChartsNow() {
    if (!this.width) return
    const [from, to] = this.window
    const columns = Math.max(50, Math.floor(this.width - kScale))
    const samples = sample(this.run, this.achieved, from, to, columns)
    const window = [this.run.seconds(from), this.run.seconds(to)]
    for (const chart of this.charts) if (!chart.element.hidden) chart.draw(samples, window)
    if (!this.scope.element.hidden) this.scope.draw(from, to, kScale)
    if (!this.lanes.element.hidden) this.lanes.draw(from, to, kScale)
    this.drawAxis(window)
    this.placeCursor()
  }
  // One time axis for all charts, at the bottom.
  drawAxis([from, to]) {
    const height = 24, width = this.width
    sizeCanvas(this.axis, width, height)
    const context = contextOf(this.axis, width)
    context.font = '11px system-ui, "Noto Sans", "DejaVu Sans", sans-serif'
    context.fillStyle = context.strokeStyle = colour('faint')
    context.textAlign = 'center'
    context.textBaseline = 'middle'
    const { step, list } = ticks(from, to, Math.max(3, (width - kScale) / 110))
    const digits = decimals(step)
    for (const at of list) {
      const x = kScale + (at - from) / (to - from) * (width - kScale)
      context.beginPath()
      context.moveTo(x, 0)
      context.lineTo(x, 4)
      context.stroke()
      const text = fixed(at, digits)
      const half = context.measureText(text).width / 2
      if (x - half > 0 && x + half < width) context.fillText(text, x, 14)
    }
    const clocks = (to - from) * this.run.clockHz
    byId('axis').firstChild.textContent = clocks < 4000 ? `${grouped(clocks)} clocks in view · s` : 's'
  }

  // ---- time

  setWindow(from, to) {
    const all = this.run.cycles
    let width = Math.min(Math.max(to - from, kLeast), all)
    if (width !== to - from) from = (from + to - width) / 2
    from = Math.min(Math.max(0, from), all - width)
    this.window = [from, from + width]
    this.drawCharts()
  }
  zoomTime(factor, at = this.cycle) {
    const [from, to] = this.window
    if (at < from || at > to) at = (from + to) / 2
    this.setWindow(at - (at - from) * factor, at + (to - at) * factor)
  }
  closeTime() {
    // Keeps a pulse or two in view, if they are not too far away.
    const { times, count } = this.run.executed
    const next = lastAtMost(times, this.cycle) + 1
    const way = Math.min(next < count ? times[next] - this.cycle : Infinity, next > 0 ? this.cycle - times[next - 1] : Infinity)
    const half = Math.min(2000, Math.max(kLeast, 1.5 * way + 10))
    this.setWindow(this.cycle - half, this.cycle + half)
  }
  setCycle(cycle, reveal = false) {
    this.cycle = Math.min(Math.max(0, cycle), this.run.cycles)
    const [from, to] = this.window
    if (reveal && (this.cycle < from || this.cycle > to)) this.setWindow(this.cycle - (to - from) / 2, this.cycle + (to - from) / 2)
    if (this.cursorFrame) return
    this.cursorFrame = requestAnimationFrame(() => { this.cursorFrame = 0; this.showCursor() })
  }
  showCursor() {
    const { run, cycle } = this
    const now = readout(run, this.achieved, cycle)
    for (const chart of this.charts) chart.read(now)
    this.scope.read(now)
    this.lanes.read(cycle)
    this.view.setCycle(cycle)
    const line = run.paths.count ? run.paths.lines[now.path] : 0
    this.program.highlight(line)
    byId('clock').textContent = `${fixed(run.seconds(cycle), 6)} s   clock ${grouped(cycle)}   line ${line}`
    byId('place').replaceChildren(...run.axes.map((axis, a) => {
      const pulses = run.kinematics.hasOwnMotor(a) ? `  ${String(now.positions[a]).padStart(8)}` : ''
      return make('span', {}, `${axis.letter} ${fixed(run.coordinateAt(a, cycle), 3).padStart(9)}${pulses}`)
    }))
    this.placeCursor()
  }
  placeCursor() {
    const [from, to] = this.window
    const share = (this.cycle - from) / (to - from)
    const cursor = byId('cursor')
    cursor.hidden = share < 0 || share > 1 || !this.width
    const left = this.axis.parentElement.offsetLeft
    cursor.style.left = `${left + kScale + share * (this.width - kScale)}px`
    cursor.style.height = `${byId('rows').offsetHeight}px`
  }
  goToLine(line) {
    this.setCycle(this.run.beginOfLine(line), true)
  }
  // The next pulse of any axis, or the previous one.
  stepPulse(by) {
    const { times, count } = this.run.executed
    if (!count) return
    const at = Math.floor(this.cycle)
    const i = by > 0 ? lastAtMost(times, at) + 1 : lastAtMost(times, at - 1)
    this.setCycle(times[Math.min(count - 1, Math.max(0, i))], true)
  }

  // ---- mouse and keys

  listen() {
    const charts = byId('charts')
    const cycleAt = (event) => {
      const box = this.axis.getBoundingClientRect()
      const share = (event.clientX - box.left - kScale) / (box.width - kScale)
      return this.window[0] + share * (this.window[1] - this.window[0])
    }
    let grip = null
    charts.addEventListener('pointerdown', (event) => {
      if (event.target.closest('.label') || event.button > 1) return
      charts.setPointerCapture(event.pointerId)
      const pan = event.shiftKey || event.button === 1
      grip = { pan, x: event.clientX, window: [...this.window] }
      if (!pan) this.setCycle(cycleAt(event))
      event.preventDefault()
      charts.focus({ preventScroll: true })
    })
    charts.addEventListener('pointermove', (event) => {
      if (!grip) return
      if (!grip.pan) return this.setCycle(cycleAt(event))
      const by = (event.clientX - grip.x) / (this.width - kScale) * (grip.window[1] - grip.window[0])
      this.setWindow(grip.window[0] - by, grip.window[1] - by)
    })
    for (const end of ['pointerup', 'pointercancel']) charts.addEventListener(end, () => { grip = null })
    charts.addEventListener('wheel', (event) => {
      if (event.target.closest('.label')) return
      event.preventDefault()
      const along = Math.abs(event.deltaX) > Math.abs(event.deltaY) || event.shiftKey
      const [from, to] = this.window
      if (along) {
        const by = (event.deltaX || event.deltaY) / this.width * (to - from)
        this.setWindow(from + by, to + by)
      } else {
        this.zoomTime(2 ** (event.deltaY / 240), cycleAt(event))
      }
    }, { passive: false })
    this.listenSplitter()
    byId('theme').addEventListener('click', () => this.theme())
    byId('help').addEventListener('click', () => this.dialog(helpText()))
    byId('licences').addEventListener('click', () => this.dialog(licenceText()))
    document.addEventListener('keydown', (event) => this.key(event))
  }
  listenSplitter() {
    const splitter = byId('splitter')
    const set = (height) => document.documentElement.style.setProperty('--time-height', `${Math.max(120, Math.min(innerHeight - 220, height))}px`)
    let held = false
    splitter.addEventListener('pointerdown', (event) => { held = true; splitter.setPointerCapture(event.pointerId) })
    splitter.addEventListener('pointermove', (event) => { if (held) set(innerHeight - event.clientY - 4) })
    splitter.addEventListener('pointerup', () => { held = false })
    splitter.addEventListener('keydown', (event) => {
      const by = { ArrowUp: 20, ArrowDown: -20 }[event.key]
      if (by) { set(byId('time').offsetHeight + by); event.preventDefault(); event.stopPropagation() }
    })
  }
  theme(dark = !isDark()) {
    setTheme(dark)
    this.view.paint()
    this.legend()
    this.resizeCharts()
  }
  dialog(content) {
    byId('dialog-text').replaceChildren(...content)
    byId('dialog').showModal()
  }
  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || byId('dialog').open) return
    const width = this.window[1] - this.window[0]
    const step = event.shiftKey ? 0.1 : 0.01
    const keys = {
      ArrowRight: () => this.setCycle(this.cycle + step * width, true), ArrowLeft: () => this.setCycle(this.cycle - step * width, true),
      '.': () => this.stepPulse(1), ',': () => this.stepPulse(-1),
      Home: () => this.setCycle(0, true), End: () => this.setCycle(this.run.cycles, true),
      n: () => this.nextLine(1), b: () => this.nextLine(-1),
      '+': () => this.zoomTime(0.5), '=': () => this.zoomTime(0.5), '-': () => this.zoomTime(2),
      0: () => this.setWindow(0, this.run.cycles), k: () => this.closeTime(),
      f: () => this.view.fit(), p: () => this.view.close(),
      1: () => this.view.look('iso'), 2: () => this.view.look('top'), 3: () => this.view.look('front'), 4: () => this.view.look('side'),
      i: () => this.view.zoomBy(1.5), o: () => this.view.zoomBy(1 / 1.5),
      c: () => this.setMode(this.modes[(this.modes.findIndex((one) => one.dataset.mode === this.view.mode) + 1) % this.modes.length].dataset.mode),
      r: () => document.querySelector('[data-show="rapid"]').click(), e: () => document.querySelector('[data-show="executed"]').click(),
      g: () => document.querySelector('[data-show="grid"]').click(),
      s: () => this.openTab(byId('summary').hidden ? 'summary' : 'program'), t: () => this.theme(), '?': () => this.dialog(helpText()),
    }
    const act = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key]
    if (!act) return
    act()
    event.preventDefault()
  }
  nextLine(by) {
    const { paths } = this.run
    let p = this.run.pathAt(this.cycle)
    const line = paths.lines[p]
    while (p + by >= 0 && p + by < paths.count && paths.lines[p] === line) p += by
    while (by < 0 && p > 0 && paths.lines[p - 1] === paths.lines[p]) --p
    this.setCycle(this.run.pathBegin[p], true)
  }
}

function helpText() {
  const rows = [
    ['← →', 'cursor, with Shift ten times as far'], [', .', 'cursor to the pulse before, to the next one'],
    ['B N', 'cursor to the line before, to the next one'], ['Home End', 'cursor to the start, to the end'],
    ['+ − 0', 'less time, more time, the whole run'], ['K', 'single clocks at the cursor'],
    ['F P', 'all of the path; the tool, pulse by pulse'], ['1 2 3 4', '3-D, top, front, side'], ['I O', 'path nearer, farther'],
    ['C', 'colour by speed, axis load, deviation'], ['R E G', 'rapids, executed pulses, grid'],
    ['S', 'summary or program'], ['T', 'light or dark'],
  ]
  return [
    make('h2', {}, 'Keys'), make('dl', {}, ...rows.flatMap(([keys, what]) => [make('dt', {}, keys), make('dd', {}, what)])),
    make('h2', {}, 'Mouse'), make('p', {}, 'Path: drag turns it, the right button moves it, the wheel zooms. Charts: press or drag to put the cursor there, the wheel zooms, Shift and drag moves. A click on a line of the program puts the cursor where the line begins.'),
    make('h2', {}, 'What is shown'), make('p', {}, 'Commanded: speeds, accelerations and jerks of the feed pieces that went to the card, at an override of 100 %. Achieved: from the intervals between the pulses at the pins; the band reaches from the least to the most in a column. Grey: nothing is commanded to move. Dashed: limits of the machine file.'),
  ]
}
function licenceText() {
  // eslint-disable-next-line no-undef
  return TRAMMEL_LICENCES.flatMap(({ name, version, license, text }) => [make('h2', {}, `${name} ${version} (${license})`), make('pre', {}, text)])
}

async function main() {
  setTheme(matchMedia('(prefers-color-scheme: dark)').matches)
  try {
    const streams = await readStreams(document)
    const facts = JSON.parse(byId('facts').textContent)
    const page = new Page(new Run(streams, facts))
    byId('loading').remove()
    // For tests, and for inspecting a run in the browser's console.
    window.trammel = page
    requestAnimationFrame(() => requestAnimationFrame(() => { document.documentElement.dataset.ready = 'true' }))
  } catch (error) {
    byId('loading').textContent = `This page cannot be shown: ${error.message}`
    throw error
  }
}
main()

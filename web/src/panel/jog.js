// Jogging by buttons and keys. While one is held, the page sends a message every 100 ms; the server ends the jog when
// it has received none for 300 ms.
import { byId, make } from '../dom.js'

const kSay = 100  // ms
const kSteps = [0, 0.01, 0.1, 1, 10]
const kPercents = [1, 5, 10, 25, 50, 100]
const kKeys = { ArrowLeft: ['X', -1], ArrowRight: ['X', 1], ArrowDown: ['Y', -1], ArrowUp: ['Y', 1], PageDown: ['Z', -1], PageUp: ['Z', 1] }
// Positions in the pad: column, row.
const kPlaces = { 'X-1': [1, 2], X1: [3, 2], Y1: [2, 1], 'Y-1': [2, 3], Z1: [4, 1], 'Z-1': [4, 3] }

export class Jogger {
  constructor(link, axes) {
    this.link = link
    this.axes = axes
    this.last = Date.now()
    this.jog = null
    this.fill()
    for (const event of ['blur', 'pagehide']) window.addEventListener(event, () => this.letGo())
    document.addEventListener('visibilitychange', () => { if (document.hidden) this.letGo() })
  }
  fill() {
    const pad = byId('pad')
    pad.replaceChildren()
    let row = 4
    for (const [index, { letter }] of this.axes.entries()) {
      for (const way of [-1, 1]) {
        const [column, at] = kPlaces[letter + way] ?? [way < 0 ? 1 : 3, row]
        const button = make('button', { type: 'button', id: `jog-${letter}-${way < 0 ? 'minus' : 'plus'}`, 'aria-label': `Jog ${letter} ${way < 0 ? 'minus' : 'plus'}` }, `${letter}${way < 0 ? '−' : '+'}`)
        Object.assign(button.style, { gridColumn: column, gridRow: at })
        this.listen(button, index, way)
        pad.append(button)
      }
      if (!kPlaces[letter + 1]) ++row
    }
    const unit = this.axes.every(({ unit }) => unit === 'mm') ? 'mm' : 'mm or °'
    byId('step').replaceChildren(...kSteps.map((step) => make('option', { value: step }, step ? `${step} ${unit}` : 'while held')))
    byId('percent').replaceChildren(...kPercents.map((percent) => {
      const speed = Math.min(...this.axes.filter(({ unit }) => unit === 'mm').map((axis) => axis.max_velocity_per_min)) * percent / 100
      return make('option', { value: percent, selected: percent === 25 }, Number.isFinite(speed) ? `${percent} % (${Math.round(speed)} mm/min)` : `${percent} %`)
    }))
    // Takes the focus away, so that arrow keys jog and do not change the selection.
    for (const id of ['step', 'percent']) byId(id).addEventListener('change', ({ target }) => target.blur())
  }
  listen(button, index, way) {
    button.addEventListener('pointerdown', (event) => {
      if (event.button !== 0) return
      event.preventDefault()
      button.focus({ preventScroll: true })
      button.setPointerCapture(event.pointerId)
      this.press(index, way, button)
    })
    for (const event of ['pointerup', 'pointercancel', 'lostpointercapture']) button.addEventListener(event, () => this.letGo(button))
    button.addEventListener('contextmenu', (event) => event.preventDefault())
    button.addEventListener('keydown', (event) => {
      if (event.key === 'Enter' && !event.repeat) this.press(index, way, button)
      if (event.key === 'Enter') event.preventDefault()
    })
    button.addEventListener('keyup', (event) => { if (event.key === 'Enter') this.letGo(button) })
  }
  // Whether the key is a jog key.
  keyDown(event) {
    if (!kKeys[event.key] || !byId('keys').checked) return false
    const [letter, way] = kKeys[event.key]
    const index = this.axes.findIndex((axis) => axis.letter === letter)
    if (index >= 0 && !event.repeat) this.press(index, way, event.key)
    return index >= 0
  }
  keyUp(event) {
    if (kKeys[event.key]) this.letGo(event.key)
  }
  press(axis, way, by) {
    if (this.jog) return
    const id = ++this.last
    const step = Number(byId('step').value)
    if (!this.link.send('jog', { id, axis, way, step, percent: Number(byId('percent').value) })) return
    const button = byId(`jog-${this.axes[axis].letter}-${way < 0 ? 'minus' : 'plus'}`)
    button.classList.add('held')
    const timer = setInterval(() => { if (!this.link.send('held', { id })) this.end() }, kSay)
    this.jog = { id, by, button, timer, step }
  }
  // A step continues to its end; a jog without distance ends here.
  letGo(by = null) {
    if (!this.jog || (by !== null && this.jog.by !== by) || this.jog.step !== 0) return
    this.link.send('release', { id: this.jog.id })
    this.end()
  }
  end() {
    if (!this.jog) return
    clearInterval(this.jog.timer)
    this.jog.button.classList.remove('held')
    this.jog = null
  }
  // Handles the server's messages about jogs that it has accepted, that have ended, or that it has refused.
  state({ jog, jog_taken: taken }) {
    if (this.jog && taken >= this.jog.id && jog !== this.jog.id) this.end()
  }
}

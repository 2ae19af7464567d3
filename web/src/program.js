// The program's lines, as text; only those in view are in the document.
import { make } from './dom.js'

const kLine = 18

export class Program {
  constructor(element, run, go) {
    this.element = element
    this.run = run
    this.go = go
    this.lines = new Map()
    this.now = 0
    this.digits = String(run.program.length).length
    this.space = make('div', { style: `height: ${run.program.length * kLine + 8}px; width: 1px` })
    element.append(this.space)
    element.addEventListener('scroll', () => this.show())
    new ResizeObserver(() => this.show()).observe(element)
    this.show()
  }
  show() {
    const { element, run } = this
    const from = Math.max(0, Math.floor(element.scrollTop / kLine) - 10)
    const to = Math.min(run.program.length, Math.ceil((element.scrollTop + element.clientHeight) / kLine) + 10)
    for (const [line, shown] of this.lines) {
      if (line < from || line >= to) {
        shown.remove()
        this.lines.delete(line)
      }
    }
    for (let line = from; line < to; ++line) {
      if (this.lines.has(line)) continue
      const still = run.firstPath[line + 1] < 0
      const number = make('span', { class: 'number', style: `width: ${this.digits}ch` }, String(line + 1))
      const element = make('div', { class: 'line', 'data-line': line + 1 }, number, make('span', { class: still ? 'still' : '' }, run.program[line]))
      element.style.top = `${line * kLine + 4}px`
      element.addEventListener('click', () => this.go(line + 1))
      this.lines.set(line, element)
      this.element.append(element)
      if (line + 1 === this.now) element.classList.add('now')
    }
  }
  // Lines count from 1.
  highlight(line, scroll = true) {
    if (line === this.now) return
    this.lines.get(this.now - 1)?.classList.remove('now')
    this.now = line
    this.lines.get(line - 1)?.classList.add('now')
    const top = (line - 1) * kLine, { scrollTop, clientHeight } = this.element
    if (scroll && (top < scrollTop + 2 * kLine || top > scrollTop + clientHeight - 4 * kLine)) {
      this.element.scrollTop = top - clientHeight / 2
    }
  }
}

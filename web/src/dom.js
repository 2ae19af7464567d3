// Makes elements directly: text of a program stays text and never becomes markup.
export function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag)
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value)
    else if (value === true) element.setAttribute(name, '')
    else if (value !== false && value != null) element.setAttribute(name, value)
  }
  element.append(...children.filter((child) => child != null))
  return element
}
// Clears a canvas and sets its size on the page, in the screen's own pixels.
export function sizeCanvas(canvas, width, height) {
  const ratio = window.devicePixelRatio || 1
  Object.assign(canvas, { width: Math.round(width * ratio), height: Math.round(height * ratio) })
  Object.assign(canvas.style, { width: `${width}px`, height: `${height}px` })
}
// The context for drawing in the page's pixels.
export function contextOf(canvas, width) {
  const context = canvas.getContext('2d')
  const ratio = canvas.width / width
  context.setTransform(ratio, 0, 0, ratio, 0, 0)
  return context
}
export const byId = (id) => document.getElementById(id)

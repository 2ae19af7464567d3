// The tool: a cone with its tip at the tool's position. It has a small canvas over the path, which is only moved, so
// that the cursor never redraws the path.
import { Vector3 } from 'three'
import { colour } from './theme.js'

const kHeight = 24    // height of the cone, pixels
const kRadius = 8.6
const kCorners = 24   // corners of its base
const kSide = 64      // side of the canvas; the tip is in its middle

export class Tool {
  constructor() {
    this.position = new Vector3()  // mm from the run's middle
    this.canvas = document.createElement('canvas')
    this.canvas.className = 'tool'
  }
  // Moves the canvas to the tip's place; redraws the cone if the direction of view or the colours have changed.
  draw(camera, width, height, ratio) {
    const at = this.position.clone().project(camera)
    const x = (at.x + 1) / 2 * width, y = (1 - at.y) / 2 * height
    this.canvas.style.transform = `translate(${x - kSide / 2}px, ${y - kSide / 2}px)`
    const key = [...camera.quaternion.toArray(), ratio, colour('cursor')].join()
    if (key === this.key) return
    this.key = key
    this.drawCone(camera.matrixWorldInverse.elements, ratio)
  }
  // The base and the triangles from it to the tip cover the cone's outline.
  drawCone(matrix, ratio) {
    this.canvas.width = this.canvas.height = kSide * ratio
    const context = this.canvas.getContext('2d')
    context.setTransform(ratio, 0, 0, ratio, kSide / 2 * ratio, kSide / 2 * ratio)
    context.fillStyle = context.strokeStyle = colour('cursor')
    context.lineWidth = 0.5  // closes the seams between the triangles
    const base = Array.from({ length: kCorners }, (_, i) => {
      const angle = 2 * Math.PI * i / kCorners
      const [x, y, z] = [kRadius * Math.cos(angle), kRadius * Math.sin(angle), kHeight]
      return [matrix[0] * x + matrix[4] * y + matrix[8] * z, -(matrix[1] * x + matrix[5] * y + matrix[9] * z)]
    })
    const fill = (...corners) => {
      context.beginPath()
      for (const corner of corners) context.lineTo(...corner)
      context.closePath()
      context.fill()
      context.stroke()
    }
    fill(...base)
    base.forEach((corner, i) => fill([0, 0], corner, base[(i + 1) % kCorners]))
  }
}

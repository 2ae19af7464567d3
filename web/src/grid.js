// The grid on the ground below the path, and, close up, a second grid at the height of the part in view.
import { BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments } from 'three'
import { colour } from './theme.js'
import { niceStep } from './format.js'

const linesOf = (points) => new BufferGeometry().setAttribute('position', new BufferAttribute(Float32Array.from(points), 3))

export class Grid {
  // Size and bounding box of the path, and one pulse of the finest axis, mm.
  constructor(run, size, box, pulse) {
    this.run = run
    this.pulse = pulse
    this.shown = true
    this.rule(size, box)
    this.lines = new LineSegments(this.ground(), new LineBasicMaterial())
    this.near = new LineSegments(new BufferGeometry(), new LineBasicMaterial())
    for (const object of this.objects()) {
      object.material.depthWrite = false
      object.renderOrder = -1
      object.frustumCulled = false
    }
  }
  objects() { return [this.lines, this.near] }
  paint() {
    for (const object of this.objects()) object.material.color.set(colour('grid'))
  }
  rule(size, box) {
    const step = niceStep(Math.max(size[0], size[1], size[2] / 2, 1e-3) / 10)
    const { centre } = this.run
    const [x, y] = [0, 1].map((i) => {
      const low = Math.floor((box.low[i] + centre[i]) / step + 0.02) * step
      const high = Math.max(low + step, Math.ceil((box.high[i] + centre[i]) / step - 0.02) * step)
      return { low, high, count: Math.round((high - low) / step) }
    })
    this.ruled = { step, x, y, z: box.low[2] }
  }
  ground() {
    const { step, x, y, z } = this.ruled
    const { centre } = this.run
    const points = []
    for (let i = 0; i <= x.count; ++i) {
      const at = x.low + i * step - centre[0]
      points.push(at, y.low - centre[1], z, at, y.high - centre[1], z)
    }
    for (let i = 0; i <= y.count; ++i) {
      const at = y.low + i * step - centre[1]
      points.push(x.low - centre[0], at, z, x.high - centre[0], at, z)
    }
    return linesOf(points)
  }
  // Lines of the grid on the ground, as a flat list of places.
  corners() {
    const { x, y, z } = this.ruled
    const { centre } = this.run
    return [x.low, x.high].flatMap((px) => [y.low, y.high].flatMap((py) => [px - centre[0], py - centre[1], z]))
  }
  // Shows the grid that the camera sees well; close up, its lines are single pulses if these are far enough apart.
  update(camera, target) {
    const { zoom } = camera
    const { centre } = this.run
    const near = this.ruled.step * zoom > 320
    const apart = this.pulse * zoom >= 10
    const step = apart ? this.pulse : niceStep(48 / zoom)
    this.near.visible = this.shown
    this.lines.visible = this.shown && !near
    const key = near ? [step, ...['x', 'y', 'z'].map((d) => Math.round(target[d] / step / 8)), Math.round(4 * Math.log2(zoom))].join() : ''
    if (key === this.nearKey) return
    this.nearKey = key
    const points = []
    if (near) {
      const half = Math.hypot(camera.right, camera.top) / zoom * 1.4 + 8 * step
      const count = Math.min(400, Math.ceil(half / step))
      const z = apart ? Math.round((target.z + centre[2]) / step) * step - centre[2] : target.z
      const x0 = Math.round((target.x + centre[0]) / step) * step - centre[0]
      const y0 = Math.round((target.y + centre[1]) / step) * step - centre[1]
      for (let i = -count; i <= count; ++i) {
        points.push(x0 + i * step, y0 - count * step, z, x0 + i * step, y0 + count * step, z)
        points.push(x0 - count * step, y0 + i * step, z, x0 + count * step, y0 + i * step, z)
      }
    }
    this.near.geometry.dispose()
    this.near.geometry = linesOf(points)
  }
}

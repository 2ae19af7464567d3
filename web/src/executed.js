// The executed pulses: a thinned-out line for the whole run; close up, each pulse in view.
import { BufferAttribute, BufferGeometry, CanvasTexture, Color, Line, LineBasicMaterial, LineSegments, Points, PointsMaterial } from 'three'
import { colour, ramp } from './theme.js'
import { lastAtMost } from './run.js'

const kChunk = 512      // executed places per bounding box
const kDetail = 200000  // most executed places in full detail
const kThin = 60000     // most executed places for the whole run

// A round dot.
function disc() {
  const canvas = document.createElement('canvas')
  canvas.width = canvas.height = 32
  const context = canvas.getContext('2d')
  context.fillStyle = '#fff'
  context.arc(16, 16, 15, 0, 7)
  context.fill()
  return new CanvasTexture(canvas)
}
const geometryOf = (places) => new BufferGeometry().setAttribute('position', new BufferAttribute(places, 3))

export class Executed {
  // Extent: the largest side of the path; pulse: one pulse of the finest axis (mm).
  constructor(run, extent, pulse) {
    this.run = run
    this.pulse = pulse
    this.shown = true
    this.count = 0  // places in full detail
    this.boxes = boxesOf(run.executed)
    this.thin = new Line(geometryOf(thinned(run.executed, extent)), new LineBasicMaterial())  // opaque, or it would be drawn last
    this.detail = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ transparent: true, opacity: 0.85 }))
    this.dots = new Points(new BufferGeometry(), new PointsMaterial({ size: 5, sizeAttenuation: false, map: disc(), alphaTest: 0.5, transparent: true }))
    for (const object of this.objects()) {
      object.material.depthTest = object.material.depthWrite = false
      object.frustumCulled = false
      // For the whole run below the commanded lines; pulse by pulse above them.
      object.renderOrder = object === this.thin ? -1 : 2
    }
  }
  objects() { return [this.thin, this.detail, this.dots] }
  paint() {
    this.thin.material.color.set(colour('panel')).lerp(new Color(colour('executed')), 0.3)
    this.detail.material.color.set(colour('executed'))
  }
  show(on) {
    this.shown = on
    this.hide(false)
  }
  // Hides them temporarily, independent of the setting.
  hide(hidden) {
    this.detail.visible = this.dots.visible = this.shown && !hidden
    this.thin.visible = this.shown && !hidden && !this.count
  }
  // Shows the pulses in view, or, if there are too many, those nearest in time to the clock. Dots are coloured by
  // deviation if a largest one is given.
  update(camera, cycle, mostDeviation) {
    const { places } = this.run.executed
    const apart = camera.zoom * this.pulse  // pixels per pulse
    const ranges = apart < 0.8 ? [] : this.inView(camera, cycle)
    this.count = ranges.reduce((sum, [from, to]) => sum + to - from, 0)
    const points = new Float32Array(3 * this.count)
    let at = 0
    for (const [from, to] of ranges) {
      points.set(places.subarray(3 * from, 3 * to), at)
      at += 3 * (to - from)
    }
    this.detail.geometry.dispose()
    this.dots.geometry.dispose()
    this.detail.geometry = stairs(points, ranges)
    const dotted = apart >= 4, byDeviation = mostDeviation !== undefined
    this.dots.material.vertexColors = byDeviation
    this.dots.material.color.set(byDeviation ? '#ffffff' : colour('executed'))
    this.dots.material.needsUpdate = true
    this.dots.material.size = Math.min(9, Math.max(3, apart / 2)) * Math.min(window.devicePixelRatio || 1, 2)
    this.dots.geometry = geometryOf(dotted ? points : new Float32Array(0))
    if (byDeviation && dotted) this.dots.geometry.setAttribute('color', new BufferAttribute(this.deviationColours(ranges, mostDeviation), 3))
    this.hide(false)
  }
  deviationColours(ranges, most) {
    const colours = new Float32Array(3 * this.count)
    const rgb = [0, 0, 0], linear = new Color()
    let at = 0
    for (const [from, to] of ranges) {
      for (let i = from; i < to; ++i, at += 3) {
        ramp(this.run.executed.deviations[i] / most, rgb)
        linear.setRGB(rgb[0], rgb[1], rgb[2], 'srgb').toArray(colours, at)
      }
    }
    return colours
  }
  // Ranges of executed places whose boxes are in view, at most kDetail places in total.
  inView(camera, cycle) {
    const { count, times } = this.run.executed
    const { elements } = camera.matrixWorldInverse
    const halfX = camera.right / camera.zoom, halfY = camera.top / camera.zoom
    const found = []
    for (let c = 0; 6 * c < this.boxes.length; ++c) {
      const { x, y, reachX, reachY } = seen(this.boxes.subarray(6 * c, 6 * c + 6), elements)
      if (Math.abs(x) <= halfX + reachX && Math.abs(y) <= halfY + reachY) found.push(c)
    }
    const most = Math.floor(kDetail / kChunk)
    const now = lastAtMost(times, cycle) / kChunk
    const kept = found.length <= most ? found
      : found.map((c) => [Math.abs(c - now), c]).sort((p, q) => p[0] - q[0]).slice(0, most).map((p) => p[1]).sort((p, q) => p - q)
    const ranges = []
    for (const c of kept) {
      const from = c * kChunk, to = Math.min(count, from + kChunk)
      if (ranges.length && ranges.at(-1)[1] === from) ranges.at(-1)[1] = to
      else ranges.push([from, to])
    }
    return ranges
  }
}

// A box in the camera's right and up directions: its centre and half sizes.
function seen(box, matrix) {
  let x = matrix[12], y = matrix[13], reachX = 0, reachY = 0
  for (let d = 0; d < 3; ++d) {
    const middle = (box[d] + box[3 + d]) / 2, reach = (box[3 + d] - box[d]) / 2
    x += matrix[4 * d] * middle
    y += matrix[4 * d + 1] * middle
    reachX += Math.abs(matrix[4 * d]) * reach
    reachY += Math.abs(matrix[4 * d + 1]) * reach
  }
  return { x, y, reachX, reachY }
}

// Places with at least a certain distance from the previous one; the distance doubles while there are too many.
function thinned({ places, count }, extent) {
  for (let least = Math.max(extent, 1e-6) / 3000; ; least *= 2) {
    const kept = []
    let x = Infinity, y = 0, z = 0
    for (let i = 0; i < count && kept.length <= 3 * kThin; ++i) {
      const dx = places[3 * i] - x, dy = places[3 * i + 1] - y, dz = places[3 * i + 2] - z
      if (dx * dx + dy * dy + dz * dz < least * least && i + 1 < count) continue
      x = places[3 * i]
      y = places[3 * i + 1]
      z = places[3 * i + 2]
      kept.push(x, y, z)
    }
    if (kept.length <= 3 * kThin) return Float32Array.from(kept)
  }
}

// The minimum and maximum corner of each chunk.
function boxesOf({ places, count }) {
  const chunks = Math.ceil(count / kChunk)
  const boxes = new Float32Array(6 * chunks)
  for (let c = 0; c < chunks; ++c) {
    const box = [Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity]
    for (let i = c * kChunk; i < Math.min(count, (c + 1) * kChunk); ++i) {
      for (let d = 0; d < 3; ++d) {
        const at = places[3 * i + d]
        if (at < box[d]) box[d] = at
        if (at > box[3 + d]) box[3 + d] = at
      }
    }
    boxes.set(box, 6 * c)
  }
  return boxes
}

// Lines between the places of each range; two ranges are not joined.
function stairs(points, ranges) {
  const index = new Uint32Array(2 * ranges.reduce((sum, [from, to]) => sum + to - from - 1, 0))
  let n = 0, at = 0
  for (const [from, to] of ranges) {
    for (let i = from; i + 1 < to; ++i, ++at) {
      index[n++] = at
      index[n++] = at + 1
    }
    ++at
  }
  return geometryOf(points).setIndex(new BufferAttribute(index, 1))
}

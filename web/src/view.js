// The tool path in three dimensions: commanded lines in colour, rapids apart, the executed pulses where they can be told
// apart, and the tool. Orthographic, so that plan views measure; the camera's zoom is pixels a mm.
import {
  BufferAttribute, BufferGeometry, Color, ConeGeometry, LineBasicMaterial, LineDashedMaterial, LineSegments, Line, Mesh,
  MeshBasicMaterial, MOUSE, OrthographicCamera, Points, PointsMaterial, Scene, CanvasTexture, Vector3, WebGLRenderer,
} from 'three'
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js'
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js'
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js'
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js'
import { boxOf, courseOf } from './course.js'
import { axisColour, colour, ramp } from './theme.js'
import { decimals, fixed, niceStep } from './format.js'
import { lastAtMost } from './run.js'

const kWide = 120000    // lines that are drawn wider than a pixel
const kChunk = 512      // executed places with a box of their own
const kDetail = 200000  // executed places at most in full detail
const kThin = 60000     // and over the whole run

const directions = {
  iso: new Vector3(-0.55, -1, 0.85),
  top: new Vector3(0, -1e-5, 1),
  front: new Vector3(0, -1, 0),
  side: new Vector3(1, 0, 0),
}
export const coloured = {
  speed: { label: 'Speed', unit: 'mm/s' },
  load: { label: 'Axis load', unit: '% of max_acceleration' },
  deviation: { label: 'Deviation', unit: 'pulses' },
}

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

export class View {
  constructor(element, run, changed) {
    this.element = element
    this.run = run
    this.changed = changed
    this.mode = 'speed'
    this.shown = { rapid: true, executed: true, grid: true }
    this.renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true })
    this.overlay = document.createElement('canvas')
    element.append(this.renderer.domElement, this.overlay)
    this.scene = new Scene()
    this.camera = new OrthographicCamera(-1, 1, 1, -1, -1e5, 1e5)
    this.camera.up.set(0, 0, 1)
    this.controls = new OrbitControls(this.camera, element)
    this.controls.enableDamping = false
    this.controls.zoomToCursor = true
    this.controls.mouseButtons = { LEFT: MOUSE.ROTATE, MIDDLE: MOUSE.PAN, RIGHT: MOUSE.PAN }
    this.controls.addEventListener('change', () => { this.draw(); this.detailSoon() })
    this.box = boxOf(run)
    this.course = courseOf(run)
    this.build()
    new ResizeObserver(() => this.resize()).observe(element)
    this.resize()
    this.look('iso')
  }

  // ---- what is in the scene

  build() {
    const { feed, rapid } = this.course
    this.wide = feed.points.length / 6 <= kWide
    if (this.wide) {
      this.feed = new LineSegments2(new LineSegmentsGeometry(), new LineMaterial({ vertexColors: true, linewidth: 2.6 }))
      if (feed.points.length) this.feed.geometry.setPositions(feed.points)
    } else {
      this.feed = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ vertexColors: true }))
      this.feed.geometry.setAttribute('position', new BufferAttribute(Float32Array.from(feed.points), 3))
    }
    this.feed.visible = feed.points.length > 0
    this.feed.frustumCulled = false
    this.rapid = new LineSegments(new BufferGeometry(), new LineDashedMaterial({ dashSize: 1, gapSize: 1 }))
    this.rapid.geometry.setAttribute('position', new BufferAttribute(Float32Array.from(rapid.points), 3))
    this.rapid.computeLineDistances()
    this.rapid.frustumCulled = false
    this.thin = new Line(new BufferGeometry(), new LineBasicMaterial())  // opaque, or it would be drawn last
    this.detail = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ transparent: true, opacity: 0.85 }))
    this.dots = new Points(new BufferGeometry(), new PointsMaterial({ size: 5, sizeAttenuation: false, map: disc(), alphaTest: 0.5, transparent: true }))
    this.grid = new LineSegments(new BufferGeometry(), new LineBasicMaterial())
    this.near = new LineSegments(new BufferGeometry(), new LineBasicMaterial())
    this.tool = new Mesh(new ConeGeometry(0.36, 1, 24).rotateX(-Math.PI / 2).translate(0, 0, 0.5), new MeshBasicMaterial({ transparent: true, opacity: 0.92 }))
    // Under the commanded lines over the whole run, above them pulse by pulse.
    this.thin.material.depthTest = this.thin.material.depthWrite = false
    this.grid.material.depthWrite = this.near.material.depthWrite = false
    for (const object of [this.detail, this.dots]) {
      object.material.depthTest = object.material.depthWrite = false
      object.renderOrder = 2
    }
    this.thin.renderOrder = this.grid.renderOrder = this.near.renderOrder = -1
    this.feed.renderOrder = 1
    this.tool.renderOrder = 3
    for (const object of [this.thin, this.detail, this.dots, this.grid, this.near, this.tool]) object.frustumCulled = false
    this.scene.add(this.grid, this.near, this.thin, this.rapid, this.feed, this.detail, this.dots, this.tool)
    this.buildExecuted()
    this.buildGrid()
    this.paint()
  }
  buildExecuted() {
    const { places, count } = this.run.executed
    const size = this.size()
    // Each at least a distance from the one before; where that makes too many, twice the distance.
    let kept
    for (let least = Math.max(...size, 1e-6) / 3000; ; least *= 2) {
      kept = []
      let x = Infinity, y = 0, z = 0
      for (let i = 0; i < count && kept.length <= 3 * kThin; ++i) {
        const dx = places[3 * i] - x, dy = places[3 * i + 1] - y, dz = places[3 * i + 2] - z
        if (dx * dx + dy * dy + dz * dz < least * least && i + 1 < count) continue
        x = places[3 * i]
        y = places[3 * i + 1]
        z = places[3 * i + 2]
        kept.push(x, y, z)
      }
      if (kept.length <= 3 * kThin) break
    }
    this.thin.geometry.setAttribute('position', new BufferAttribute(Float32Array.from(kept), 3))
    const chunks = Math.ceil(count / kChunk)
    this.boxes = new Float32Array(6 * chunks)
    for (let c = 0; c < chunks; ++c) {
      const box = [Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity]
      for (let i = c * kChunk; i < Math.min(count, (c + 1) * kChunk); ++i) {
        for (let d = 0; d < 3; ++d) {
          const at = places[3 * i + d]
          if (at < box[d]) box[d] = at
          if (at > box[3 + d]) box[3 + d] = at
        }
      }
      this.boxes.set(box, 6 * c)
    }
    const finest = Math.max(...this.run.space.filter((a) => a >= 0).map((a) => this.run.axes[a].steps_per_mm), 1e-9)
    this.pulse = 1 / finest  // mm
  }
  size() { return this.box.high.map((x, i) => Math.max(0, x - this.box.low[i])) }
  buildGrid() {
    const size = this.size()
    const span = Math.max(size[0], size[1], size[2] / 2, 1e-3)
    const step = niceStep(span / 10)
    const { centre } = this.run
    const range = [0, 1].map((i) => {
      const low = Math.floor((this.box.low[i] + centre[i]) / step + 0.02) * step
      const high = Math.max(low + step, Math.ceil((this.box.high[i] + centre[i]) / step - 0.02) * step)
      return { low, high, count: Math.round((high - low) / step) }
    })
    const z = this.box.low[2]
    const points = []
    const [x, y] = range
    for (let i = 0; i <= x.count; ++i) {
      const at = x.low + i * step - centre[0]
      points.push(at, y.low - centre[1], z, at, y.high - centre[1], z)
    }
    for (let i = 0; i <= y.count; ++i) {
      const at = y.low + i * step - centre[1]
      points.push(x.low - centre[0], at, z, x.high - centre[0], at, z)
    }
    this.grid.geometry.setAttribute('position', new BufferAttribute(Float32Array.from(points), 3))
    this.ruled = { step, x, y, z }
  }
  // Close up a grid of its own around what is in view, at its height; single pulses where they are wide apart.
  nearGrid() {
    const { zoom } = this.camera
    const target = this.controls.target, { centre } = this.run
    const near = this.ruled.step * zoom > 320
    const apart = this.pulse * zoom >= 10
    const step = apart ? this.pulse : niceStep(48 / zoom)
    const key = near ? [step, ...['x', 'y', 'z'].map((d) => Math.round(target[d] / step / 8)), Math.round(4 * Math.log2(zoom))].join() : ''
    if (key === this.nearKey) return
    this.nearKey = key
    const points = []
    if (near) {
      const half = Math.hypot(this.camera.right, this.camera.top) / zoom * 1.4 + 8 * step
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
    this.near.geometry = new BufferGeometry().setAttribute('position', new BufferAttribute(Float32Array.from(points), 3))
  }

  // ---- colours

  scaleOf(mode) {
    const values = this.course.feed[mode]
    let most = 0
    for (let i = 0; i < values.length; ++i) if (values[i] > most) most = values[i]
    return mode === 'load' ? Math.max(most, 1) : most || 1
  }
  paint() {
    const values = this.course.feed[this.mode]
    const most = this.scaleOf(this.mode)
    const colours = new Float32Array(3 * values.length)
    const rgb = [0, 0, 0]
    const linear = new Color()
    for (let i = 0; i < values.length; ++i) {
      ramp(values[i] / most, rgb)
      linear.setRGB(rgb[0], rgb[1], rgb[2], 'srgb')
      colours[3 * i] = linear.r
      colours[3 * i + 1] = linear.g
      colours[3 * i + 2] = linear.b
    }
    if (this.wide) {
      if (values.length) this.feed.geometry.setColors(colours)
    } else {
      this.feed.geometry.setAttribute('color', new BufferAttribute(colours, 3))
    }
    this.scene.background = new Color(colour('panel'))
    this.rapid.material.color.set(colour('rapid'))
    this.thin.material.color.set(colour('panel')).lerp(new Color(colour('executed')), 0.3)
    this.detail.material.color.set(colour('executed'))
    this.grid.material.color.set(colour('grid'))
    this.near.material.color.set(colour('grid'))
    this.tool.material.color.set(colour('cursor'))
    this.draw()
  }
  setMode(mode) { this.mode = mode; this.paint(); this.detailNow() }
  show(what, on) {
    this.shown[what] = on
    this.rapid.visible = this.shown.rapid
    this.thin.visible = this.detail.visible = this.dots.visible = this.shown.executed
    this.grid.visible = this.near.visible = this.shown.grid
    if (on && what === 'executed') this.detailNow()
    this.draw()
  }

  // ---- camera

  resize() {
    const width = Math.max(1, this.element.clientWidth), height = Math.max(1, this.element.clientHeight)
    const ratio = Math.min(window.devicePixelRatio || 1, 2)
    this.renderer.setPixelRatio(ratio)
    this.renderer.setSize(width, height)
    this.overlay.width = width * ratio
    this.overlay.height = height * ratio
    this.overlay.style.width = `${width}px`
    this.overlay.style.height = `${height}px`
    Object.assign(this.camera, { left: -width / 2, right: width / 2, top: height / 2, bottom: -height / 2 })
    this.camera.updateProjectionMatrix()
    if (this.wide) this.feed.material.resolution.set(width, height)
    if (this.fitted) this.fit()
    this.draw()
    this.detailSoon()
  }
  look(name) {
    this.camera.position.copy(this.controls.target).addScaledVector(directions[name].clone().normalize(), 1000)
    this.camera.lookAt(this.controls.target)
    this.fit()
  }
  // All of the path in the view, whatever the direction.
  fit() {
    this.camera.updateMatrixWorld()
    const inverse = this.camera.matrixWorldInverse
    const low = new Vector3(Infinity, Infinity, Infinity), high = new Vector3(-Infinity, -Infinity, -Infinity)
    const width = this.camera.right * 2, height = this.camera.top * 2
    const at = new Vector3()
    const take = (list, every) => {
      for (let i = 0; i + 2 < list.length; i += 3 * every) {
        at.fromArray(list, i).applyMatrix4(inverse)
        low.min(at)
        high.max(at)
      }
    }
    const { feed, rapid } = this.course
    for (const { points } of [feed, rapid]) take(points, Math.max(1, Math.floor(points.length / 15000)))
    if (low.x > high.x) take([...this.box.low, ...this.box.high], 1)
    // The numbers at the grid too.
    if (this.shown.grid) {
      const { x, y, z } = this.ruled
      const { centre } = this.run
      for (const px of [x.low, x.high]) for (const py of [y.low, y.high]) {
        const at = new Vector3(px - centre[0], py - centre[1], z).applyMatrix4(inverse)
        low.min(at)
        high.max(at)
      }
    }
    const spanX = Math.max(high.x - low.x, 40 * this.pulse), spanY = Math.max(high.y - low.y, 40 * this.pulse)
    // Room for the tools above, and for the numbers around the grid.
    const above = 52, around = 22
    this.camera.zoom = Math.min((width - 4 * around) / spanX, (height - above - 2 * around) / spanY)
    const middle = new Vector3((low.x + high.x) / 2, (low.y + high.y) / 2 + above / 2 / this.camera.zoom, (low.z + high.z) / 2)
      .applyMatrix4(this.camera.matrixWorld)
    this.moveTo(middle)
    this.fitted = true
  }
  moveTo(target) {
    this.camera.position.add(target.clone().sub(this.controls.target))
    this.controls.target.copy(target)
    this.camera.updateProjectionMatrix()
    this.controls.update()
    this.fitted = false
    this.draw()
    this.detailSoon()
  }
  // The tool in the middle, single pulses wide apart.
  close() {
    this.camera.zoom = 16 / this.pulse
    this.moveTo(this.tool.position)
  }
  zoomBy(factor) {
    this.camera.zoom *= factor
    this.moveTo(this.controls.target.clone())
  }

  // ---- the executed pulses in view

  detailSoon() {
    clearTimeout(this.waiting)
    this.waiting = setTimeout(() => this.detailNow(), 60)
  }
  detailNow() {
    const { places } = this.run.executed
    const apart = this.camera.zoom * this.pulse  // pixels a pulse
    const list = apart < 0.8 ? [] : this.visible()
    const points = new Float32Array(3 * list.reduce((sum, [from, to]) => sum + to - from, 0))
    let at = 0
    for (const [from, to] of list) {
      points.set(places.subarray(3 * from, 3 * to), at)
      at += 3 * (to - from)
    }
    this.detailCount = points.length / 3
    const attribute = new BufferAttribute(points, 3)
    this.detail.geometry.dispose()
    this.dots.geometry.dispose()
    this.detail.geometry = stairs(points, list)
    const byDeviation = this.mode === 'deviation'
    this.dots.material.vertexColors = byDeviation
    this.dots.material.color.set(byDeviation ? '#ffffff' : colour('executed'))
    this.dots.material.needsUpdate = true
    this.dots.geometry = new BufferGeometry().setAttribute('position', apart >= 4 ? attribute : new BufferAttribute(new Float32Array(0), 3))
    if (byDeviation && apart >= 4) this.dots.geometry.setAttribute('color', new BufferAttribute(this.deviationColours(list), 3))
    this.dots.material.size = Math.min(9, Math.max(3, apart / 2)) * Math.min(window.devicePixelRatio || 1, 2)
    this.draw()
  }
  deviationColours(list) {
    const most = this.scaleOf('deviation')
    const colours = new Float32Array(3 * list.reduce((sum, [from, to]) => sum + to - from, 0))
    const rgb = [0, 0, 0], linear = new Color()
    let at = 0
    for (const [from, to] of list) {
      for (let i = from; i < to; ++i, at += 3) {
        ramp(this.run.executed.deviations[i] / most, rgb)
        linear.setRGB(rgb[0], rgb[1], rgb[2], 'srgb').toArray(colours, at)
      }
    }
    return colours
  }
  // Ranges of executed places whose boxes are in view, kDetail in all.
  visible() {
    const { count, times } = this.run.executed
    const matrix = this.camera.matrixWorldInverse
    const [a, b] = [matrix.elements, this.camera]
    const halfX = b.right / b.zoom, halfY = b.top / b.zoom
    const inView = (c) => {
      const box = this.boxes
      // The box in the camera's right and up: its middle, and how far it reaches.
      let x = a[12], y = a[13], rx = 0, ry = 0
      for (let d = 0; d < 3; ++d) {
        const middle = (box[6 * c + d] + box[6 * c + 3 + d]) / 2, reach = (box[6 * c + 3 + d] - box[6 * c + d]) / 2
        x += a[4 * d] * middle
        y += a[4 * d + 1] * middle
        rx += Math.abs(a[4 * d]) * reach
        ry += Math.abs(a[4 * d + 1]) * reach
      }
      return Math.abs(x) <= halfX + rx && Math.abs(y) <= halfY + ry
    }
    const chunks = Math.ceil(count / kChunk)
    const found = []
    for (let c = 0; c < chunks; ++c) if (inView(c)) found.push(c)
    // Where that is too much, what is nearest in time to the cursor.
    const most = Math.floor(kDetail / kChunk)
    const now = lastAtMost(times, this.cycle ?? 0) / kChunk
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

  // ---- tool and drawing

  setCycle(cycle) {
    this.cycle = cycle
    const at = this.run.space.map((axis, i) => axis < 0 ? 0
      : this.run.positionAt(axis, cycle) / this.run.axes[axis].steps_per_mm - this.run.centre[i])
    this.tool.position.set(...at)
    this.draw()
  }
  draw() {
    if (this.frame) return
    this.frame = requestAnimationFrame(() => { this.frame = 0; this.drawNow() })
  }
  drawNow() {
    const { zoom } = this.camera
    this.tool.scale.setScalar(24 / zoom)
    this.rapid.material.dashSize = 6 / zoom
    this.rapid.material.gapSize = 5 / zoom
    this.nearGrid()
    this.grid.visible = this.shown.grid && !this.nearKey
    this.thin.visible = this.shown.executed && !this.detailCount
    this.renderer.render(this.scene, this.camera)
    this.annotate()
    this.changed?.()
  }
  // Numbers at the grid, start and end, the scale, and where the axes point.
  annotate() {
    const { overlay, camera } = this
    const ratio = overlay.width / Math.max(1, this.element.clientWidth)
    const context = overlay.getContext('2d')
    context.setTransform(ratio, 0, 0, ratio, 0, 0)
    const width = overlay.width / ratio, height = overlay.height / ratio
    context.clearRect(0, 0, width, height)
    context.font = '11px system-ui, "Noto Sans", "DejaVu Sans", sans-serif'
    const at = (x, y, z) => {
      const p = new Vector3(x, y, z).project(camera)
      return [(p.x + 1) / 2 * width, (1 - p.y) / 2 * height]
    }
    if (this.grid.visible) this.numberGrid(context, at)
    this.markEnds(context, at)
    this.drawScale(context, width, height)
    this.drawAxes(context, height)
  }
  numberGrid(context, at) {
    const { x, y, z } = this.ruled
    const { centre } = this.run
    context.fillStyle = colour('faint')
    context.textAlign = 'center'
    context.textBaseline = 'middle'
    const rule = (range, place, outward, step = this.ruled.step) => {
      const digits = decimals(step)
      const p = place(range.low), q = place(range.high)
      const gap = Math.hypot(q[0] - p[0], q[1] - p[1]) / Math.max(1, range.count)
      if (!(gap > 3)) return
      const every = Math.max(1, Math.ceil(34 / gap))
      for (let i = 0; i <= range.count; ++i) {
        const value = range.low + i * step
        if (every > 1 && Math.round(value / step) % every !== 0) continue
        const [px, py] = place(value)
        const last = i + every > range.count
        context.fillText(`${fixed(value, digits)}${last ? ' mm' : ''}`, px + outward[0], py + outward[1])
      }
    }
    const towards = (from, to) => {
      const d = [from[0] - to[0], from[1] - to[1]], size = Math.hypot(...d) || 1
      return [d[0] / size * 15, d[1] / size * 12]
    }
    const xs = (v) => at(v - centre[0], y.low - centre[1], z)
    const ys = (v) => at(x.low - centre[0], v - centre[1], z)
    const xMiddle = (x.low + x.high) / 2, yMiddle = (y.low + y.high) / 2
    const size = this.size()
    if (size[0] > 0) rule(x, xs, towards(xs(xMiddle), at(xMiddle - centre[0], y.high - centre[1], z)))
    if (size[1] > 0) rule(y, ys, towards(ys(yMiddle), at(x.high - centre[0], yMiddle - centre[1], z)))
    // Heights, where they matter: at the corner that stands to the left.
    if (size[2] < 0.25 * Math.max(size[0], size[1])) return
    const corners = [[x.low, y.low], [x.low, y.high], [x.high, y.low], [x.high, y.high]]
    if (!(size[0] + size[1] > 0)) corners.splice(0, 4, centre)
    const left = corners.reduce((p, q) => at(q[0] - centre[0], q[1] - centre[1], z)[0] < at(p[0] - centre[0], p[1] - centre[1], z)[0] ? q : p)
    const zStep = niceStep(size[2] / 8)
    const low = Math.ceil((this.box.low[2] + centre[2]) / zStep - 1e-6) * zStep
    const zs = (v) => at(left[0] - centre[0], left[1] - centre[1], v - centre[2])
    rule({ low, count: Math.floor(size[2] / zStep + 1e-6), high: low + Math.floor(size[2] / zStep + 1e-6) * zStep }, zs, [-26, 0], zStep)
  }
  markEnds(context, at) {
    const { run } = this
    if (run.paths.count === 0) return
    const place = (pulses) => at(...run.space.map((axis, i) => axis < 0 ? 0 : pulses(axis) / run.axes[axis].steps_per_mm - run.centre[i]))
    const begin = place((axis) => run.start[axis])
    const end = place((axis) => run.endOf(run.paths.count - 1, axis))
    const same = Math.hypot(begin[0] - end[0], begin[1] - end[1]) < 12
    const mark = ([x, y], text, below) => {
      context.lineWidth = 1.6
      context.strokeStyle = colour('ink')
      context.fillStyle = colour('panel')
      context.beginPath()
      context.arc(x, y, 4, 0, 7)
      context.fill()
      context.stroke()
      context.textAlign = 'left'
      context.textBaseline = 'middle'
      context.lineWidth = 3
      context.strokeStyle = colour('panel')
      context.strokeText(text, x + 9, y + (below ? 11 : -10))
      context.fillStyle = colour('ink')
      context.fillText(text, x + 9, y + (below ? 11 : -10))
    }
    if (!same) mark(end, 'end', true)
    mark(begin, same ? 'start and end' : 'start', false)
  }
  drawScale(context, width, height) {
    const step = niceStep(70 / this.camera.zoom)
    const length = step * this.camera.zoom
    const x = 92, y = height - 20
    context.strokeStyle = colour('ink')
    context.fillStyle = colour('ink')
    context.lineWidth = 1.2
    context.beginPath()
    context.moveTo(x, y - 4); context.lineTo(x, y); context.lineTo(x + length, y); context.lineTo(x + length, y - 4)
    context.stroke()
    context.textAlign = 'left'
    context.textBaseline = 'bottom'
    const text = step >= 1 ? `${fixed(step, 0)} mm` : step >= 1e-3 ? `${fixed(step, decimals(step))} mm` : `${fixed(step * 1e3, decimals(step * 1e3))} µm`
    const pulses = step / this.pulse
    context.fillText(pulses < 1e4 ? `${text} = ${fixed(pulses, pulses < 10 ? 1 : 0)} pulses` : text, x, y - 5)
  }
  drawAxes(context, height) {
    const origin = [42, height - 40]
    const matrix = this.camera.matrixWorldInverse.elements
    const arms = this.run.space.map((axis, i) => ({ letter: 'XYZ'[i], axis, x: matrix[4 * i] * 26, y: -matrix[4 * i + 1] * 26, depth: matrix[4 * i + 2] }))
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
      context.textAlign = 'center'
      context.textBaseline = 'middle'
      context.fillText(arm.letter, origin[0] + arm.x * (1 + 9 / length), origin[1] + arm.y * (1 + 9 / length))
    }
  }
}

// Lines between the places of each range; two ranges are not joined.
function stairs(points, list) {
  const index = new Uint32Array(2 * list.reduce((sum, [from, to]) => sum + to - from - 1, 0))
  let n = 0, at = 0
  for (const [from, to] of list) {
    for (let i = from; i + 1 < to; ++i, ++at) {
      index[n++] = at
      index[n++] = at + 1
    }
    ++at
  }
  return new BufferGeometry().setAttribute('position', new BufferAttribute(points, 3)).setIndex(new BufferAttribute(index, 1))
}

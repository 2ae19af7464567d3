// The tool path in three dimensions: commanded lines in colour, rapids in another style, the executed pulses if they
// are far enough apart, and the tool on top. The camera is orthographic, so that plan views are to scale; its zoom is
// pixels per mm. While the view moves, a long path is drawn as an outline. The whole path is drawn when the view is
// still, slice by slice, so that the next movement waits for only one slice.
import {
  BufferAttribute, BufferGeometry, Color, Group, LineBasicMaterial, LineDashedMaterial, LineSegments, MOUSE,
  OrthographicCamera, Scene, Vector3, WebGLRenderer,
} from 'three'
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js'
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js'
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js'
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js'
import { Annotations } from './annotations.js'
import { boxOf, courseOf } from './course.js'
import { Executed } from './executed.js'
import { Grid } from './grid.js'
import { outline } from './outline.js'
import { drawsInSoftware } from './software.js'
import { colour, ramp } from './theme.js'
import { Tool } from './tool.js'

const kWide = 10000    // most lines that are drawn wider than a pixel
const kOutline = 4000  // most lines that are drawn while the view moves
const kSlice = 10000   // most lines per frame of a still view
const kStill = 150     // ms after the last movement until the view counts as still

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

export class View {
  // Over: elements on top of this one, the tools first; the path is fitted below the tools.
  constructor(element, run, over) {
    this.element = element
    this.over = over
    this.run = run
    this.mode = 'speed'
    this.box = boxOf(run)
    this.size = this.box.high.map((x, i) => Math.max(0, x - this.box.low[i]))
    this.pulse = Math.min(...run.space.filter((a) => a >= 0).map((a) => run.kinematics.pulseOf(a)), 1e9)  // mm, of the finest axis
    this.course = courseOf(run)
    this.lines = this.course.feed.points.length / 6
    this.wide = this.lines <= kWide
    this.software = drawsInSoftware()
    // On a processor, smooth edges of a long path take longer than the path itself.
    this.renderer = new WebGLRenderer({ antialias: this.wide || !this.software, preserveDrawingBuffer: true })
    this.renderer.info.autoReset = false  // counts all slices of a drawing
    this.annotations = new Annotations(this)
    this.tool = new Tool()
    element.append(this.renderer.domElement, this.annotations.canvas, this.tool.canvas)
    this.scene = new Scene()
    this.camera = new OrthographicCamera(-1, 1, 1, -1, -1e5, 1e5)
    this.camera.up.set(0, 0, 1)
    this.controls = new OrbitControls(this.camera, element)
    this.controls.enableDamping = false
    this.controls.zoomToCursor = true
    this.controls.mouseButtons = { LEFT: MOUSE.ROTATE, MIDDLE: MOUSE.PAN, RIGHT: MOUSE.PAN }
    this.controls.addEventListener('change', () => this.moved())
    this.build()
    const resized = new ResizeObserver(() => this.resize())
    resized.observe(element)
    resized.observe(over[0])
    this.resize()
    this.look('iso')
  }

  // ---- what is in the scene

  build() {
    const { feed, rapid } = this.course
    if (this.wide) {
      this.feed = new LineSegments2(new LineSegmentsGeometry(), new LineMaterial({ vertexColors: true, linewidth: 2.6 }))
      if (feed.points.length) this.feed.geometry.setPositions(feed.points)
    } else {
      this.feed = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ vertexColors: true }))
    }
    this.rapid = new LineSegments(new BufferGeometry(), new LineDashedMaterial({ dashSize: 1, gapSize: 1 }))
    this.rapid.geometry.setAttribute('position', new BufferAttribute(Float32Array.from(rapid.points), 3))
    this.rapid.computeLineDistances()
    this.feed.renderOrder = 1
    this.outline = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ vertexColors: true }))
    this.outline.geometry.setAttribute('position', new BufferAttribute(Float32Array.from(feed.points), 3))
    this.outline.geometry.setIndex(new BufferAttribute(outline(feed.points, kOutline), 1))
    if (!this.wide) this.feed.geometry.setAttribute('position', this.outline.geometry.getAttribute('position'))
    for (const object of [this.feed, this.rapid, this.outline]) object.frustumCulled = false
    this.executed = new Executed(this.run, Math.max(...this.size), this.pulse)
    this.grid = new Grid(this.run, this.size, this.box, this.pulse)
    this.scene.add(...this.grid.objects(), this.rapid, this.feed, this.outline, this.executed.thin)
    this.closeUp = new Group().add(this.executed.detail, this.executed.dots)  // above the last slice
    this.paint()
  }
  // Shows or hides a part: 'rapid', 'executed', 'grid'.
  isShown(what) { return what === 'rapid' ? this.rapid.visible : this[what].shown }
  show(what, on) {
    if (what === 'rapid') this.rapid.visible = on
    if (what === 'grid') this.grid.shown = on
    if (what === 'executed') this.executed.show(on)
    this.draw()
  }

  // ---- colours

  // The largest value of a colour scale.
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
      linear.setRGB(rgb[0], rgb[1], rgb[2], 'srgb').toArray(colours, 3 * i)
    }
    this.outline.geometry.setAttribute('color', new BufferAttribute(colours, 3))
    if (!this.wide) this.feed.geometry.setAttribute('color', this.outline.geometry.getAttribute('color'))
    else if (values.length) this.feed.geometry.setColors(colours)
    this.scene.background = new Color(colour('panel'))
    this.rapid.material.color.set(colour('rapid'))
    this.placeTool()
    this.grid.paint()
    this.executed.paint()
    this.detailNow()
  }
  setMode(mode) { this.mode = mode; this.paint() }

  // ---- camera

  resize() {
    const width = Math.max(1, this.element.clientWidth), height = Math.max(1, this.element.clientHeight)
    const ratio = Math.min(window.devicePixelRatio || 1, 2)
    this.renderer.setPixelRatio(ratio)
    this.renderer.setSize(width, height)
    this.annotations.resize(width, height, ratio)
    Object.assign(this.camera, { left: -width / 2, right: width / 2, top: height / 2, bottom: -height / 2 })
    this.camera.updateProjectionMatrix()
    if (this.wide) this.feed.material.resolution.set(width, height)
    if (this.fitted) this.fit()
    this.moved()
  }
  look(name) {
    this.camera.position.copy(this.controls.target).addScaledVector(directions[name].clone().normalize(), 1000)
    this.camera.lookAt(this.controls.target)
    this.fit()
  }
  // Fits the whole path into the view, for any direction.
  fit() {
    this.camera.updateMatrixWorld()
    const inverse = this.camera.matrixWorldInverse
    const low = new Vector3(Infinity, Infinity, Infinity), high = new Vector3(-Infinity, -Infinity, -Infinity)
    const width = this.camera.right * 2, height = this.camera.top * 2
    const at = new Vector3()
    const take = (list, every = 1) => {
      for (let i = 0; i + 2 < list.length; i += 3 * every) {
        at.fromArray(list, i).applyMatrix4(inverse)
        low.min(at)
        high.max(at)
      }
    }
    const { feed, rapid } = this.course
    for (const { points } of [feed, rapid]) take(points, Math.max(1, Math.floor(points.length / 15000)))
    if (low.x > high.x) take([...this.box.low, ...this.box.high])
    // With room for the numbers at the grid.
    if (this.grid.shown) take(this.grid.corners())
    const spanX = Math.max(high.x - low.x, 40 * this.pulse), spanY = Math.max(high.y - low.y, 40 * this.pulse)
    // Leaves room for the tools at the top (in a low view they may cover a part), for the numbers around the grid, and
    // for the scale.
    const covered = this.over[0].getBoundingClientRect().bottom - this.element.getBoundingClientRect().top
    const above = Math.min(Math.max(0, covered + 12), height / 4), around = 22, below = 46
    this.camera.zoom = Math.min((width - 4 * around) / spanX, (height - above - around - below) / spanY)
    const middle = new Vector3((low.x + high.x) / 2, (low.y + high.y) / 2 + (above + around - below) / 2 / this.camera.zoom, (low.z + high.z) / 2)
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
    this.moved()
  }
  // The tool in the middle, with single pulses far apart.
  close() {
    this.camera.zoom = 16 / this.pulse
    this.moveTo(this.tool.position)
  }
  zoomBy(factor) {
    this.camera.zoom *= factor
    this.moveTo(this.controls.target.clone())
  }

  // ---- tool and drawing

  setCycle(cycle) {
    this.cycle = cycle
    const at = this.run.space.map((axis, i) => axis < 0 ? 0
      : this.run.coordinateAt(axis, cycle) - this.run.centre[i])
    this.tool.position.set(...at)
    this.placeTool()
  }
  placeTool() { this.tool.draw(this.camera, 2 * this.camera.right, 2 * this.camera.top, this.renderer.getPixelRatio()) }
  moved() {
    this.moving = true
    this.draw()
    clearTimeout(this.waiting)
    this.waiting = setTimeout(() => this.detailNow(), kStill)
  }
  detailNow() {
    this.moving = false
    this.executed.update(this.camera, this.cycle ?? 0, this.mode === 'deviation' ? this.scaleOf('deviation') : undefined)
    this.draw()
  }
  draw() { this.nextFrame(() => this.drawNow()) }
  // Replaces any other request for that frame.
  nextFrame(act) {
    this.act = act
    this.frame ||= requestAnimationFrame(() => { this.frame = 0; this.act() })
  }
  drawNow() {
    const { zoom } = this.camera
    // A processor needs several frames for wide lines, even for few of them.
    const quick = this.moving && (this.software || this.lines > kOutline)
    this.outline.visible = quick
    this.feed.visible = !quick && this.lines > 0
    this.executed.hide(quick)
    this.rapid.material.dashSize = 6 / zoom
    this.rapid.material.gapSize = 5 / zoom
    this.grid.update(this.camera, this.controls.target)
    this.renderer.info.reset()
    this.renderer.autoClear = true
    this.drawSlice(this.scene, 0, quick || this.wide ? 0 : this.lines)
    this.annotations.draw()
    this.placeTool()
  }
  // Draws lines of the path from the first one on, with all other objects, and the following ones in the next frame.
  drawSlice(object, first, lines) {
    if (!this.wide) this.feed.geometry.setDrawRange(2 * first, 2 * kSlice)
    this.renderer.render(object, this.camera)
    this.renderer.autoClear = false
    const next = first + kSlice
    if (next < lines) this.nextFrame(() => this.drawSlice(this.feed, next, lines))
    else this.renderer.render(this.closeUp, this.camera)
  }
}

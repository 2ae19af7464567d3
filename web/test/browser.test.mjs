// The page in headless Chromium: it draws, the cursor works, the console has no messages, and a program's text stays
// text.
//   TRAMMEL=.../trammel TRAMMEL_EXAMPLES=examples CHROMIUM=... node --test browser.test.mjs
import assert from 'node:assert/strict'
import { mkdtempSync, rmSync, statSync, writeFileSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { join } from 'node:path'
import { after, before, test } from 'node:test'
import { chromium } from 'playwright-core'
import { trammel, trammelStops } from './page.mjs'

const command = process.env.TRAMMEL
const examples = process.env.TRAMMEL_EXAMPLES
const folder = mkdtempSync(join(tmpdir(), 'trammel-'))
let browser
before(async () => {
  // No graphics card is used; as root in a container, there is no sandbox.
  browser = await chromium.launch({ executablePath: process.env.CHROMIUM, args: ['--no-sandbox', '--enable-unsafe-swiftshader'] })
})
after(async () => {
  await browser?.close()
  rmSync(folder, { recursive: true })
})

function report(text, ...options) {
  const program = join(folder, 'program.ngc'), page = join(folder, 'report.html')
  writeFileSync(program, text)
  trammel(command, 'run', program, '--engine', 'model', '--report', page, ...options)
  return page
}
// The report of the example, for all tests that look at it.
let partPage
function partReport() {
  if (!partPage) {
    partPage = join(folder, 'part.html')
    trammel(command, 'run', join(examples, 'part.ngc'), '--engine', 'model', '--report', partPage, '--clock', '1000000')
  }
  return partPage
}
async function open(file, scheme = 'light') {
  const page = await browser.newPage({ viewport: { width: 1100, height: 700 }, colorScheme: scheme })
  const said = []
  // Without a graphics card the browser reads its pictures back and prints a warning about it.
  page.on('console', (message) => { if (!/GPU stall due to ReadPixels/.test(message.text())) said.push(message.text()) })
  page.on('pageerror', (error) => said.push(String(error)))
  page.on('request', (request) => { if (!/^(file|data|blob):/.test(request.url())) said.push(`asks for ${request.url()}`) })
  const begun = Date.now()
  await page.goto(`file://${file}`)
  await page.waitForFunction(() => document.documentElement.dataset.ready === 'true')
  const milliseconds = Date.now() - begun
  await still(page)  // before that, a moving view may show its outline
  return { page, said, milliseconds }
}
const still = (page) => page.waitForFunction(() => !window.trammel.view.moving && !window.trammel.view.frame)
// Number of pixels of a canvas that differ from its first one.
const drawn = (page, selector) => page.evaluate((name) => {
  const canvas = document.querySelector(name)
  const copy = document.createElement('canvas')
  copy.width = canvas.width
  copy.height = canvas.height
  const context = copy.getContext('2d')
  context.drawImage(canvas, 0, 0)
  const data = new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer)
  return data.reduce((count, pixel) => count + (pixel !== data[0] ? 1 : 0), 0)
}, selector)
const frame = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))))

// Close up, each executed pulse has its dot, and single clocks show.
async function lookClosely(page) {
  await page.keyboard.press('p')
  await still(page)
  const seen = await page.evaluate(() => ({ dots: window.trammel.view.executed.dots.geometry.attributes.position.count, of: window.trammel.view.executed.count }))
  assert.ok(seen.dots > 50 && seen.dots === seen.of, JSON.stringify(seen))
  await page.keyboard.press('k')
  await frame(page)
  const [[from, to], times] = await page.evaluate(() => [window.trammel.window, Array.from(window.trammel.run.executed.times)])
  assert.ok(to - from < 4100 && to - from >= 24, `${to - from} clocks`)
  assert.ok(times.some((time) => time > from && time < to), 'a pulse is in view')
}

// Texts that the next drawing of the path writes, each with its box, and the elements of the page on top of the path.
const labels = (page) => page.evaluate(async () => {
  const written = []
  const { fillText } = CanvasRenderingContext2D.prototype
  const canvas = document.querySelector('#view canvas + canvas'), { left, top } = canvas.getBoundingClientRect()
  CanvasRenderingContext2D.prototype.fillText = function (text, x, y) {
    const size = this.measureText(text)
    if (this.canvas === canvas) written.push({ text, box: [x - size.actualBoundingBoxLeft, y - size.actualBoundingBoxAscent, x + size.actualBoundingBoxRight, y + size.actualBoundingBoxDescent] })
    fillText.call(this, text, x, y)
  }
  window.trammel.view.draw()
  await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))
  CanvasRenderingContext2D.prototype.fillText = fillText
  const over = ['tools', 'legend', 'place'].map((id) => ({ text: `#${id}`, box: document.getElementById(id).getBoundingClientRect() }))
  return [...written, ...over.map(({ text, box }) => ({ text, box: [box.left - left, box.top - top, box.right - left, box.bottom - top] }))]
})
async function noLabelCoversAnother(page) {
  // In a wide view, the labels of start and end leave room for all twelve numbers of the grid.
  for (const [width, height, view, numbers] of [[1360, 920, '1', 12], [700, 900, '1', 9], [700, 900, '4', 3]]) {
    await page.setViewportSize({ width, height })
    await page.keyboard.press(view)
    await frame(page)
    const list = await labels(page)
    const where = `${width} x ${height}, view ${view}`
    assert.equal(list.filter(({ text }) => text === 'start and end').length, 1, where)
    assert.ok(list.filter(({ text }) => /^[0-9]+( mm)?$/.test(text)).length >= numbers, where)
    for (const [i, { text, box: a }] of list.entries()) {
      for (const { text: other, box: b } of list.slice(i + 1)) {
        assert.ok(a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1], `${where}: ${text} and ${other}`)
      }
    }
  }
}

for (const scheme of ['light', 'dark']) {
  test(`a part draws, ${scheme}, and the cursor moves tool, line and numbers`, async () => {
    const { page, said } = await open(partReport(), scheme)
    assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), scheme)
    assert.ok(await drawn(page, '#view canvas') > 5000, 'the path')
    assert.ok(await drawn(page, '#row-path canvas') > 500, 'the speed')
    assert.ok(await drawn(page, '#row-pins canvas') > 500, 'the pins')
    const state = () => page.evaluate(() => ({
      tool: window.trammel.view.tool.position.toArray(), line: document.querySelector('#program .now')?.dataset.line,
      clock: document.querySelector('#clock').textContent, cycle: window.trammel.cycle, left: document.querySelector('#cursor').style.left,
    }))
    const before = await state()
    const box = await page.locator('#row-path .plot').boundingBox()
    await page.mouse.click(box.x + 0.75 * box.width, box.y + 40)
    await frame(page)
    const after = await state()
    for (const what of ['tool', 'line', 'clock', 'left']) assert.notDeepEqual(after[what], before[what], what)
    assert.ok(after.cycle > 0.6 * 29e6 && after.cycle < 0.8 * 29e6, `${after.cycle}`)
    // A click on a line moves the cursor to the beginning of its path.
    await page.evaluate(() => { document.querySelector('#program').scrollTop = 0 })
    await page.locator('#program .line[data-line="13"]').click()
    await frame(page)
    assert.equal((await state()).line, '13')
    // The next pulse is one pulse further.
    const pulses = () => page.evaluate(() => window.trammel.run.motors.map((_, m) => window.trammel.run.positionAt(m, window.trammel.cycle + 20)))
    await page.locator('#charts').focus()
    const at = await pulses()
    await page.keyboard.press('.')
    await page.keyboard.press('.')
    await frame(page)
    assert.notDeepEqual(await pulses(), at)
    if (scheme === 'light') await lookClosely(page)
    else await noLabelCoversAnother(page)
    for (const key of scheme === 'dark' ? [] : ['k', '1', '2', '3', '4', 'c', 'c', 'c', 'r', 'e', 'g', 's', 't', '0', 'f', 'n', 'b', '+', '-', 'Home', 'End']) {
      await page.keyboard.press(key)
    }
    await frame(page)
    assert.deepEqual(said, [])
    await page.close()
  })
}

test('what a program says is text', async () => {
  const comments = ['</script><script>window.ran = 1</script>', '<img src=x onerror="window.ran = 2">', '<b>bold</b>']
  const { page, said } = await open(report(`G21\n${comments.map((text) => `; ${text}\n`).join('')}G1 X5 F600\n`))
  assert.equal(await page.evaluate(() => window.ran), undefined)
  assert.equal(await page.evaluate(() => document.querySelectorAll('#program img, #program b, #program script').length), 0)
  for (const text of comments) assert.ok((await page.locator('#program').textContent()).includes(text), text)
  assert.deepEqual(said, [])
  await page.close()
})

test('programs with next to nothing in them draw', async () => {
  const programs = { 'Z alone': 'G21 G90\nG1 Z3 F300\nG0 Z0\n', 'a dwell': 'G4 P0.1\n', 'E alone': 'G1 E3 F300\n' }
  for (const [name, text] of Object.entries(programs)) {
    const { page, said } = await open(report(text))
    assert.deepEqual(said, [], name)
    assert.ok(await page.evaluate(() => Number.isFinite(window.trammel.view.camera.zoom)), name)
    await page.close()
  }
})

test('a million pulses', async (context) => {
  // A slow clock has few ticks per pulse, so the simulation is fast.
  const circles = Array.from({ length: 122 }, (_, i) => `G1 X${i % 2 ? 0 : 39} Y${i % 40}\nG2 I${i % 2 ? 8 : -8} F6000\n`).join('')
  const file = report(`G21 G90 G91.1\nF6000\n${circles}`, '--clock', '100000')
  const size = statSync(file).size
  const { page, said, milliseconds } = await open(file)
  const pulses = await page.evaluate(() => window.trammel.run.pulses)
  context.diagnostic(`${pulses} pulses, ${(size / 1e6).toFixed(2)} MB, open in ${milliseconds} ms (aim 3000)`)
  assert.ok(pulses >= 1e6, `${pulses}`)
  assert.ok(size <= 5e6, `${size} bytes`)
  assert.ok(milliseconds < 10000, `${milliseconds} ms`)
  assert.deepEqual(said, [])
  await page.close()
})

// A path of many short lines: a wave along a circle.
function wave(lines, turns = 20) {
  const corner = (i) => {
    const turn = 2 * Math.PI * turns * i / lines, radius = 30 + 4 * Math.sin(7.3 * turn)
    return `G1 X${(radius * Math.cos(turn)).toFixed(3)} Y${(radius * Math.sin(turn)).toFixed(3)}\n`
  }
  return `G21 G90 G64\nF6000\n${Array.from({ length: lines }, (_, i) => corner(i)).join('')}`
}
// Milliseconds from an event in the browser until two more frames, as a median. Measured with the page's own clock,
// because a tick of the wheel takes 30 ms from here to the browser.
const rounds = process.env.TRAMMEL_LONG ? 7 : 3
async function middleTime(page, type, act, prepare = async () => {}) {
  const times = []
  for (let i = 0; i < rounds; ++i) {
    await prepare()
    await page.evaluate((name) => {
      window.took = new Promise((done) => addEventListener(name, ({ timeStamp }) => {
        requestAnimationFrame(() => requestAnimationFrame(() => done(performance.now() - timeStamp)))
      }, { capture: true, once: true }))
    }, type)
    await act()
    times.push(Math.round(await page.evaluate(() => window.took)))
  }
  return times.sort((a, b) => a - b)[(rounds - 1) / 2]
}
const drawings = (page) => page.evaluate(() => window.trammel.view.renderer.info.render.frame)
const linesDrawn = (page) => page.evaluate(() => window.trammel.view.renderer.info.render.lines)

// With TRAMMEL_LONG, the times of the long path are judged; without a graphics card, drawing all of it takes a second.
const long = process.env.TRAMMEL_LONG
test('a cursor has no path drawn anew, and a moving view has an outline drawn', async (context) => {
  const { page, said } = await open(report(long ? wave(60000, 45) : wave(1500), '--clock', '100000'))
  await page.setViewportSize({ width: 1360, height: 920 })
  await frame(page)
  await still(page)
  const all = await linesDrawn(page), before = await drawings(page)
  assert.ok(all >= (long ? 60000 : 10001), `${all} lines`)
  const tool = () => page.evaluate(() => document.querySelector('#view .tool').getBoundingClientRect().x)
  const at = await tool()
  const key = await middleTime(page, 'keydown', () => page.keyboard.press('ArrowRight'))
  assert.notEqual(await tool(), at)
  assert.equal(await drawings(page), before, 'drawings for a cursor')
  const box = await page.locator('#view').boundingBox()
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2)
  // The page records each drawing of a moving view, because the page itself decides how long a view counts as moving.
  await page.evaluate(() => {
    const { view } = window.trammel
    const { drawNow } = view
    window.movingLines = []
    view.drawNow = function () {
      drawNow.call(this)
      if (this.moving) window.movingLines.push(this.renderer.info.render.lines)
    }
  })
  const wheel = await middleTime(page, 'wheel', () => page.mouse.wheel(0, -40))
  const moving = await page.evaluate(() => window.movingLines)
  assert.ok(moving.length && Math.max(...moving) < 8000, `${moving} lines while the view moves`)
  await still(page)
  assert.ok(await linesDrawn(page) >= (long ? 60000 : 10001), 'all once it is still')
  // A tick of the wheel while the whole path is being drawn cancels the rest of that drawing.
  const stopped = []
  const late = await middleTime(page, 'wheel', () => page.mouse.wheel(0, 40), async () => {
    stopped.push(await page.evaluate(() => new Promise((done) => {
      const { view } = window.trammel
      const look = () => view.moving ? requestAnimationFrame(look) : done(view.renderer.info.render.lines)
      view.detailNow()
      requestAnimationFrame(look)
    })))
  })
  assert.ok(Math.min(...stopped) < all, `${stopped} of ${all} lines in the first frame of a still view`)
  const pulses = await page.evaluate(() => window.trammel.run.pulses)
  const times = `a key ${key} ms, a tick of the wheel ${wheel} ms, one while all is drawn ${late} ms`
  context.diagnostic(`${pulses} pulses, ${all} lines: ${times} (aim 50)`)
  if (long) assert.ok(key < 150 && wheel < 150 && late < 350, times)
  assert.equal(await page.evaluate(() => window.trammel.view.renderer.getContext().getContextAttributes().antialias), false)
  assert.deepEqual(said, [])
  await page.close()
})

test('without a graphics card a short path too is an outline while the view moves', async () => {
  const { page, said } = await open(partReport())
  await still(page)
  const shown = () => page.evaluate(() => [window.trammel.view.feed.visible, window.trammel.view.outline.visible])
  assert.deepEqual(await shown(), [true, false])
  const moving = await page.evaluate(() => new Promise((done) => {
    const { view } = window.trammel
    view.zoomBy(1.2)
    requestAnimationFrame(() => done([view.feed.visible, view.outline.visible]))
  }))
  assert.deepEqual(moving, [false, true])
  await still(page)
  assert.deepEqual(await shown(), [true, false])
  assert.deepEqual(said, [])
  await page.close()
})

async function allInView(page) {
  await frame(page)
  const seen = await page.evaluate(() => ({
    all: document.querySelector('#charts').scrollHeight, inView: document.querySelector('#charts').clientHeight,
    broken: [...document.querySelectorAll('.row .label div')].filter((one) => one.clientHeight > 17).map((one) => one.textContent),
  }))
  assert.ok(seen.all <= seen.inView, `${seen.inView} of ${seen.all} pixels`)
  assert.deepEqual(seen.broken, [])
}

// With a moving fourth axis, or with the chart of overrides; numbers have their greatest length.
for (const [name, extruder, ...options] of [['a print', ' E3'], ['an override', '', '--override-at', '0.3:57', '--hold-at', '1:0.5']]) {
  test(`all charts of ${name} are in view, each value in one line`, async () => {
    const { page, said } = await open(report(`G21 G90 M83\nG1 X-9.13 Y7.77 Z1${extruder} F1000\nG1 X5${extruder} F700\n`, ...options))
    await page.setViewportSize({ width: 1360, height: 920 })
    for (const seconds of [0.33, 0.6, 0.93, 1.7]) {
      await page.evaluate((at) => window.trammel.setCycle(at * window.trammel.run.clockHz), seconds)
      await allInView(page)
    }
    assert.deepEqual(said, [])
    await page.close()
  })
}

test('in a large window all charts are in view; in a small one nothing covers the path, and no button is cut', async () => {
  const { page, said } = await open(partReport())
  await page.setViewportSize({ width: 1360, height: 920 })
  await allInView(page)
  for (const [width, height] of [[800, 600], [390, 844], [360, 740]]) {
    await page.setViewportSize({ width, height })
    await frame(page)
    const seen = await page.evaluate(() => {
      const box = (element) => element.getBoundingClientRect()
      const view = box(document.querySelector('#view'))
      const over = ['tools', 'legend', 'place'].filter((id) => {
        const one = box(document.getElementById(id))
        return one.top < view.bottom && one.bottom > view.top && one.left < view.right && one.right > view.left
      })
      const cut = [...document.querySelectorAll('button')].filter((one) => one.offsetParent && box(one).right > innerWidth)
      return { over, cut: cut.map((one) => one.textContent), height: view.height }
    })
    assert.deepEqual({ over: seen.over, cut: seen.cut }, { over: [], cut: [] }, `${width} x ${height}`)
    assert.ok(seen.height >= 120, `the path is ${seen.height} pixels high`)
  }
  assert.deepEqual(said, [])
  await page.close()
})

// A button holds, a weak motor loses steps, a limit stops the run.
function eventfulReport() {
  const program = join(folder, 'eventful.ngc'), page = join(folder, 'eventful.html'), world = join(folder, 'world.toml'), events = join(folder, 'events.txt')
  writeFileSync(program, 'G21 G90\nG1 X20 Y5 F3000\nG1 X45 F9000\nG1 Y100 F6000\n')
  writeFileSync(world, [
    '[axis.x]', 'torque = 0.045', '[axis.y]', '[switch.y_plus]', 'input = 3', 'axis = "y"', 'above = 40',
    '[button.feed_hold]', 'input = 6', '[button.cycle_start]', 'input = 7', ''].join('\n'))
  writeFileSync(events, 'at 200 ms press feed_hold\nat 300 ms release feed_hold\nat 500 ms press cycle_start\n')
  trammelStops(command, 'run', program, '--engine', 'model', '--clock', '400000', '--report', page, '--world', world, '--world-events', events,
    '--set', 'inputs.y_limit_plus=3', '--set', 'inputs.feed_hold=6', '--set', 'inputs.cycle_start=7')
  return page
}
test('inputs, causes, reactions, and where pulses and carriage part are seen', async () => {
  const { page, said } = await open(eventfulReport())
  await page.setViewportSize({ width: 1360, height: 920 })
  await frame(page)
  assert.ok(await drawn(page, '#row-inputs canvas') > 500, 'the lanes')
  assert.ok(await drawn(page, '#row-apart canvas') > 500, 'the difference')
  const lanes = await page.evaluate(() => [...document.querySelectorAll('#row-inputs .name')].map((one) => one.textContent))
  assert.deepEqual(lanes, ['Y limit plus', 'feed hold', 'cycle start'])
  // Each has a line in the charts, and as much of its text as fits.
  const named = await page.evaluate(() => window.trammel.lanes.named)
  assert.equal(named.length, 3, named.join('; '))
  for (const name of ['feed hold button: hold', 'X loses steps', 'LIMIT (Y plus)']) {
    assert.ok(named.some((text) => text.startsWith(name)), `${name} in ${named.join('; ')}`)
  }
  await page.evaluate(() => window.trammel.setCycle(window.trammel.run.cycles))
  await frame(page)
  const states = await page.evaluate(() => [...document.querySelectorAll('#row-inputs .label b')].map((one) => one.textContent))
  assert.deepEqual(states, ['active', '–', 'active'])
  await page.locator('#tab-summary').click()
  const summary = await page.locator('#summary').textContent()
  assert.match(summary, /By LIMIT \(Y plus\), at line 4/)
  assert.match(summary, /LIMIT \(Y plus\)X 45\.000 Y 40\.\d{3}.*immediate stop/)
  assert.match(summary, /X from \d\.\d{4} s on[\d ]+ steps, \d+\.\d{3} mm at the end/)
  // The mark's time in the table moves the cursor there, and its line in the charts is under the cursor.
  await page.locator('#summary .go', { hasText: ' s' }).first().click()
  await frame(page)
  assert.ok(await page.evaluate(() => window.trammel.run.surroundings.marks.some(({ cycle }) => cycle === window.trammel.cycle)))
  for (const [width, height] of [[700, 900], [390, 844]]) {
    await page.setViewportSize({ width, height })
    await frame(page)
    const cut = await page.evaluate(() => [...document.querySelectorAll('button')].filter((one) => one.offsetParent && one.getBoundingClientRect().right > innerWidth).map((one) => one.textContent))
    assert.deepEqual(cut, [], `${width} x ${height}`)
  }
  assert.deepEqual(said, [])
  await page.close()
})

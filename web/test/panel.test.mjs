// The panel's page in headless Chromium, against trammel panel on a simulated card with a machine behind its pins.
//   TRAMMEL=.../trammel TRAMMEL_EXAMPLES=examples CHROMIUM=... node --test panel.test.mjs
import assert from 'node:assert/strict'
import { spawn } from 'node:child_process'
import { createConnection, createServer } from 'node:net'
import { once } from 'node:events'
import { join } from 'node:path'
import { after, before, test } from 'node:test'
import { chromium } from 'playwright-core'

const command = process.env.TRAMMEL
const machine = join(process.env.TRAMMEL_EXAMPLES, 'first-machine.toml')
let browser, server, address, wire
const kSpeed = 0.25 * 60      // mm/s, the page's first choice on this machine
const kAcceleration = 1000    // mm/s^2; a stop uses at least half of it
const kSilence = 0.3          // s

// A proxy between page and server. While frozen, it passes nothing and closes nothing, like a failed radio link.
async function makeWire(port) {
  const sockets = new Set()
  const wire = { frozen: false }
  const listener = createServer((page) => {
    const card = createConnection(port, '127.0.0.1')
    for (const [from, to] of [[page, card], [card, page]]) {
      sockets.add(from)
      from.on('data', (bytes) => to.write(bytes))
      from.on('close', () => { sockets.delete(from); to.destroy() })
      from.on('error', () => {})
      if (wire.frozen) from.pause()
    }
  })
  wire.freeze = (frozen) => {
    wire.frozen = frozen
    for (const socket of sockets) frozen ? socket.pause() : socket.resume()
  }
  wire.close = () => { for (const socket of sockets) socket.destroy(); listener.close() }
  listener.listen(0, '127.0.0.1')
  await once(listener, 'listening')
  wire.port = listener.address().port
  return wire
}

before(async () => {
  // As root in a container, there is no sandbox.
  browser = await chromium.launch({ executablePath: process.env.CHROMIUM, args: ['--no-sandbox'] })
  server = spawn(command, ['panel', '--engine', 'model', '--machine', machine, '--world', 'default', '--listen', '127.0.0.1:0'])
  server.stderr.on('data', (text) => { server.said = (server.said ?? '') + text })
  const [line] = await once(server.stdout, 'data')
  address = String(line).trim().replace('panel at ', '')
  wire = await makeWire(Number(new URL(address).port))
})
after(async () => {
  await browser?.close()
  wire?.close()
  if (server && server.exitCode === null) {
    server.kill('SIGTERM')
    await once(server, 'exit')
  }
})

async function open(options = { viewport: { width: 1200, height: 900 } }) {
  const page = await browser.newPage(options)
  const said = []
  page.on('console', (message) => said.push(message.text()))
  page.on('pageerror', (error) => said.push(String(error)))
  const through = new URL(address)
  through.port = wire.port
  await page.goto(String(through))
  await page.waitForFunction(() => document.documentElement.dataset.connected === 'true' && window.panel.now.state)
  return { page, said }
}
const state = (page) => page.evaluate(() => window.panel.now.state)
const until = (page, name) => page.waitForFunction((wanted) => window.panel.now.state.state === wanted, name, { timeout: 60000 })
const place = async (page) => (await state(page)).axes.map(({ machine: at }) => at)
const pause = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds))
const notes = (page) => page.locator('#notes').textContent()
// Two equal readings.
async function standing(page) {
  await until(page, 'Idle')
  const before = await place(page)
  await pause(300)
  assert.deepEqual(await place(page), before)
  return before
}
async function load(page, name, text) {
  await page.setInputFiles('#file', { name, mimeType: 'text/plain', buffer: Buffer.from(text) })
  await page.waitForFunction(() => window.panel.now.state.program.phase === 'ready')
}
async function arrow(page) {
  await page.keyboard.down('ArrowRight')
  return () => page.keyboard.up('ArrowRight')
}
// Holds the button for most of a second; returns the position after that. If a loaded host keeps the browser from
// sending for 300 ms, the jog ends, and the test holds it again.
async function held(page, press, then = async () => {}) {
  for (let n = 0; n < 5; ++n) {
    await until(page, 'Idle')
    const before = await place(page)
    const lift = await press()
    await pause(900)
    const at = await place(page)
    const way = Math.max(...at.map((value, axis) => Math.abs(value - before[axis])))
    const jogged = (await state(page)).state === 'Jog' && way > 0.4 * kSpeed
    if (jogged) await then()
    await lift()
    if (jogged) return at
    await pause(500)
  }
  assert.fail(`no jog of a second: ${await notes(page)}`)
}
async function start(page) {
  await page.locator('#start').click()
  await page.waitForFunction(() => window.panel.now.state.program.phase === 'running')
}

test('without the token there is nothing', async () => {
  const bare = new URL(address)
  bare.search = ''
  assert.equal((await fetch(bare)).status, 403)
  assert.equal((await fetch(`${address}0`)).status, 403)
  const page = await browser.newPage()
  assert.equal(await page.evaluate((url) => new Promise((done) => {
    const socket = new WebSocket(url)
    socket.onopen = () => done('open')
    socket.onerror = () => done('refused')
  }), `ws://${bare.host}/socket`), 'refused')
  await page.close()
})

// Puts a finger on a button; returns the function that lifts it.
async function touch(page, selector) {
  await page.locator(selector).scrollIntoViewIfNeeded()
  const box = await page.locator(selector).boundingBox()
  const touches = await page.context().newCDPSession(page)
  await touches.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints: [{ x: box.x + box.width / 2, y: box.y + box.height / 2 }] })
  return () => touches.send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] })
}

test('a limit switch stops a jog; the alarm says why; recover and drive off; on a phone', async () => {
  const { page, said } = await open({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true })
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth), 'no wider than the phone')
  const columns = await page.evaluate(() => new Set([...document.querySelectorAll('main > section')].map((section) => section.getBoundingClientRect().left)).size)
  assert.equal(columns, 1)
  // Not homed: the machine is locked, and jogs have no effect.
  assert.equal((await state(page)).state, 'Alarm')
  assert.match(await page.locator('#alarm').textContent(), /Not homed/)
  assert.ok(await page.locator('#jog-X-plus').isDisabled())
  await page.locator('#recover').click()
  await until(page, 'Idle')
  // Without soft limits, into the switch.
  await page.locator('#percent').selectOption('100')
  for (let n = 0; n < 5 && (await state(page)).state !== 'Alarm'; ++n) {
    await until(page, 'Idle')
    const lift = await touch(page, '#jog-X-minus')
    // A loaded host may end it before the switch, or before the page has been read.
    await page.waitForFunction(() => window.panel.now.jogger.jog, undefined, { timeout: 3000 }).catch(() => {})
    await page.waitForFunction(() => !window.panel.now.jogger.jog)
    await lift()
    await pause(300)
  }
  await until(page, 'Alarm')
  const alarm = await page.locator('#alarm').textContent()
  assert.match(alarm, /Alarm 1: .*LIMIT \(X minus\).*X -10[0-9]\.\d{3} mm/)
  const [x] = await place(page)
  assert.ok(x < -99 && x > -106, `${x}`)
  assert.match(await page.locator('#switch-X').textContent(), /limit switch/)
  await page.locator('#recover').click()
  await until(page, 'Idle')
  await page.locator('#percent').selectOption('25')
  await held(page, () => touch(page, '#jog-X-plus'))
  const [off] = await standing(page)
  assert.ok(off > x + 5, `${x} to ${off}: ${await notes(page)}`)
  assert.deepEqual(said, [])
  await page.close()
})

test('home, jog by a held key, a step, and a silent connection', async () => {
  const { page, said } = await open()
  await page.locator('#home').click()
  await until(page, 'Home')
  await until(page, 'Idle')
  assert.match(await page.locator('#homed').textContent(), /^Homed\. Soft limits of X, Y, Z are on/)
  const [x] = await standing(page)
  const before = await held(page, () => arrow(page))
  assert.ok(before[0] > x + 0.4 * kSpeed, `${before}`)
  const after = await standing(page)
  assert.ok(after[0] - before[0] < kSpeed * 0.5, `${before} to ${after}`)
  assert.equal(await page.locator('#work-X').textContent(), after[0].toFixed(3))
  // A step moves by its distance only.
  await page.locator('#step').selectOption('10')
  await page.locator('#jog-Y-plus').click()
  await until(page, 'Jog')
  const step = await standing(page)
  assert.ok(Math.abs(step[1] - after[1] - 10) < 0.02, `${after} to ${step}`)
  await page.locator('#step').selectOption('0')
  // The link freezes while the key is held.
  const last = await held(page, () => arrow(page), async () => {
    wire.freeze(true)
    await pause(1500)
    wire.freeze(false)
  })
  const stood = await standing(page)
  const far = stood[0] - last[0]
  const most = kSpeed * (kSilence + kSpeed / kAcceleration + 0.2)  // 0.2 s: last state's age, slices, load
  assert.ok(far > 0.1 * kSpeed && far < most, `${far} mm, ${most} mm at the most`)
  assert.match(await notes(page), /the page was silent for 300 ms/)
  assert.deepEqual(said, [])
  await page.close()
})

test('zero, a program with hold and resume, overrides, stop', async () => {
  const { page, said } = await open()
  await page.locator('#zero-X').click()
  await page.waitForFunction(() => document.querySelector('#work-X').textContent === '0.000')
  const [x, y] = await standing(page)
  const lines = ['G21 G90', 'G91 G1 X20 F1200 (out)', 'Y20', 'X-20', 'Y-20', 'M2']
  await load(page, 'square.ngc', lines.join('\n'))
  await start(page)
  await page.waitForFunction(() => window.panel.now.state.program.line >= 2)
  await page.keyboard.press('Space')
  await until(page, 'Hold:0')
  const held = await place(page)
  await pause(300)
  assert.deepEqual(await place(page), held)
  assert.ok(await page.locator('#program .now').count() === 1, 'the line is marked')
  await page.locator('[aria-label="Feed override minus 10 %"]').click()
  await page.waitForFunction(() => document.querySelector('#feed').textContent === '90 %')
  await page.locator('#resume').click()
  await until(page, 'Run')
  await page.waitForFunction(() => window.panel.now.state.program.phase === 'done', null, { timeout: 60000 })
  const end = await standing(page)
  assert.ok(Math.abs(end[0] - x) < 0.02 && Math.abs(end[1] - y) < 0.02, `${[x, y]} to ${end}`)
  // The same again, but stopped.
  await start(page)
  await page.waitForFunction(() => window.panel.now.state.program.line >= 3)
  await page.keyboard.press('Escape')
  await page.waitForFunction(() => window.panel.now.state.program.phase === 'stopped')
  await standing(page)
  assert.match(await page.locator('#program-state').textContent(), /stopped at line [345] of 6/)
  assert.deepEqual(said, [])
  await page.close()
})

test('the page goes in mid-program: held; a new page goes on', async () => {
  const first = await open()
  await load(first.page, 'line.ngc', 'G91 G1 X60 F1200\nX-60\n')
  await first.page.locator('#start').click()
  await until(first.page, 'Run')
  await first.page.close()
  const { page, said } = await open()
  await until(page, 'Hold:0')
  const held = await place(page)
  await pause(500)
  assert.deepEqual(await place(page), held)
  assert.equal((await state(page)).program.phase, 'running')
  await page.waitForFunction(() => document.querySelectorAll('#program .line').length >= 2)
  await page.locator('#resume').click()
  await page.waitForFunction(() => window.panel.now.state.program.phase === 'done', null, { timeout: 60000 })
  assert.deepEqual(said, [])
  await page.close()
})

test('a page whose connection is silent for 3 s has gone; it comes back by itself, and nothing moves by that', async () => {
  const { page, said } = await open()
  await load(page, 'line.ngc', 'G91 G1 X90 F1200\nX-90\n')
  await start(page)
  await until(page, 'Run')
  const [begun] = await place(page)
  wire.freeze(true)
  await pause(3800)
  wire.freeze(false)
  await page.waitForFunction(() => window.panel.link.open && document.documentElement.dataset.connected === 'true' && window.panel.now.state.state === 'Hold:0', null, { timeout: 10000 })
  const held = await place(page)
  const way = held[0] - begun
  assert.ok(way > 10 && way < 20 * 4.5, `${way} mm at 20 mm/s`)
  await pause(500)
  assert.deepEqual(await place(page), held)
  await page.keyboard.press('Escape')
  await page.waitForFunction(() => window.panel.now.state.program.phase === 'stopped')
  await standing(page)
  assert.deepEqual(said, [])
  await page.close()
})

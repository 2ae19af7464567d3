// Pictures of the panel in the middle of a program, on a simulated machine:
//   node panel-picture.mjs TRAMMEL OUT.png [light|dark] [WIDTH HEIGHT]
// CHROMIUM names the browser if it is not /usr/bin/chromium.
import { spawn } from 'node:child_process'
import { readFileSync } from 'node:fs'
import { once } from 'node:events'
import { fileURLToPath } from 'node:url'
import { chromium } from 'playwright-core'

const [trammel, out, scheme = 'light', width = '1240', height = '900'] = process.argv.slice(2)
if (!out) {
  console.error('usage: node panel-picture.mjs TRAMMEL OUT.png [light|dark] [WIDTH HEIGHT]')
  process.exit(2)
}
const example = (name) => fileURLToPath(new URL(`../examples/${name}`, import.meta.url))
// Grbl requires the end point of a circle.
const program = readFileSync(example('first-part.ngc'), 'utf8').replace('G2 I-8', 'G2 X58 Y40 I-8')
const server = spawn(trammel, ['panel', '--engine', 'model', '--machine', example('first-machine.toml'), '--world', 'default', '--listen', '127.0.0.1:0'], { stdio: ['ignore', 'pipe', 'ignore'] })
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: ['--no-sandbox'] })
try {
  const [line] = await once(server.stdout, 'data')
  const page = await browser.newPage({ viewport: { width: Number(width), height: Number(height) }, colorScheme: scheme })
  await page.goto(String(line).trim().replace('panel at ', ''))
  const state = (test, value) => page.waitForFunction(test, value, { timeout: 120000 })
  await state(() => window.panel.now.state)
  await page.click('#alarm-home')
  await state(() => window.panel.now.state.state === 'Idle')
  await page.selectOption('#step', '10')
  for (const id of ['#jog-X-plus', '#jog-Y-plus']) {
    for (let n = 0; n < 2; ++n) {
      await page.click(id)
      await state(() => window.panel.now.state.state === 'Jog')
      await state(() => window.panel.now.state.state === 'Idle')
    }
  }
  await page.click('#zero-X')
  await page.click('#zero-Y')
  await page.click('#views button:last-child')
  await page.setInputFiles('#file', { name: 'plate.ngc', mimeType: 'text/plain', buffer: Buffer.from(program) })
  await state(() => window.panel.now.state.program.phase === 'ready')
  await page.click('#start')
  await state(() => window.panel.now.state.program.line >= window.panel.now.state.program.lines * 0.55)
  await page.waitForTimeout(300)
  await page.evaluate(() => { document.activeElement?.blur(); window.scrollTo(0, 0) })
  await page.screenshot({ path: out })
} finally {
  await browser.close()
  server.kill('SIGTERM')
}

// A picture of a report:  node picture.mjs REPORT.html OUT.png [light|dark] [SECONDS]
// CHROMIUM names the browser if it is not /usr/bin/chromium.
import { resolve } from 'node:path'
import { chromium } from 'playwright-core'

const [report, out, scheme = 'light', seconds] = process.argv.slice(2)
if (!out) {
  console.error('usage: node picture.mjs REPORT.html OUT.png [light|dark] [SECONDS]')
  process.exit(2)
}
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: ['--no-sandbox', '--enable-unsafe-swiftshader'],
})
try {
  const page = await browser.newPage({ viewport: { width: 1360, height: 920 }, colorScheme: scheme })
  await page.goto(`file://${resolve(report)}`)
  await page.waitForFunction(() => document.documentElement.dataset.ready === 'true')
  if (seconds) await page.evaluate((at) => window.trammel.setCycle(at * window.trammel.run.clockHz), Number(seconds))
  // The cursor requests a frame, and the path requests another one.
  for (let i = 0; i < 5; ++i) await page.evaluate(() => new Promise((done) => requestAnimationFrame(done)))
  await page.screenshot({ path: out })
} finally {
  await browser.close()
}

// Bundles the report's page and writes it as a C++ source: what comes before a report's data and what comes behind.
//   node build.mjs OUT.cpp
import { createHash } from 'node:crypto'
import { readFileSync, writeFileSync } from 'node:fs'
import { build } from 'esbuild'

const here = (name) => new URL(name, import.meta.url)
const text = (name) => readFileSync(here(name), 'utf8')

// What is inside the page, with the licence that each asks to be passed on.
const packages = Object.keys(JSON.parse(text('package.json')).dependencies)
const licences = packages.map((name) => {
  const { version, license } = JSON.parse(text(`node_modules/${name}/package.json`))
  return { name, version, license, text: text(`node_modules/${name}/LICENSE`) }
})
licences.push({ name: 'Trammel', version: '', license: 'Apache-2.0', text: text('../LICENSE') })

const bundled = await build({
  entryPoints: [new URL('src/main.js', import.meta.url).pathname],
  bundle: true, minify: true, write: false, format: 'iife', target: 'es2022', legalComments: 'none', charset: 'ascii',
  define: { TRAMMEL_LICENCES: JSON.stringify(licences) },
})
const script = bundled.outputFiles[0].text.trimEnd()
if (/<\/script|<!--/i.test(script)) throw new Error('the bundle would end its own element')

const styles = await build({
  entryPoints: [new URL('src/style.css', import.meta.url).pathname],
  bundle: true, minify: true, write: false, charset: 'ascii',
})
const style = styles.outputFiles[0].text.trimEnd()

// Only this very script runs, and nothing is loaded: a page made of other people's programs needs a second lock.
const hash = createHash('sha256').update(script).digest('base64')
const policy = `default-src 'none'; script-src 'sha256-${hash}'; style-src 'unsafe-inline'; img-src data: blob:`
const head = text('src/page.html')
  .replace('{{policy}}', () => policy)
  .replace('{{style}}', () => style)
const tail = `<script>${script}</script>\n</body>\n</html>\n`

// In pieces, so that no line of the source is endless.
function literal(string) {
  const bytes = Buffer.from(string, 'utf8')
  const lines = []
  for (let at = 0; at < bytes.length; at += 16384) {
    let line = ''
    for (const byte of bytes.subarray(at, at + 16384)) {
      if (byte === 10) line += '\\n'
      else if (byte === 34 || byte === 92 || byte === 63) line += '\\' + String.fromCharCode(byte)
      else if (byte >= 32 && byte < 127) line += String.fromCharCode(byte)
      else line += '\\' + byte.toString(8).padStart(3, '0')
    }
    lines.push(`    "${line}"`)
  }
  return lines.join('\n')
}

writeFileSync(process.argv[2], `// Made by web/build.mjs.
#include "trammel/report/page.hpp"

namespace trammel::report {

std::string_view page_head() {
  static constexpr char kText[] =
${literal(head)};
  return {kText, sizeof kText - 1};
}

std::string_view page_tail() {
  static constexpr char kText[] =
${literal(tail)};
  return {kText, sizeof kText - 1};
}

}  // namespace trammel::report
`)

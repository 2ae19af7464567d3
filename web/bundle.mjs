// Code that the bundlers of the pages share.
import { createHash } from 'node:crypto'
import { readFileSync } from 'node:fs'
import { build } from 'esbuild'

const here = (name) => new URL(name, import.meta.url)
export const text = (name) => readFileSync(here(name), 'utf8')

// The packages in a page, with the licences that must be passed on.
export function licencesOf(packages) {
  const licences = packages.map((name) => {
    const { version, license } = JSON.parse(text(`node_modules/${name}/package.json`))
    return { name, version, license, text: text(`node_modules/${name}/LICENSE`) }
  })
  return [...licences, { name: 'Trammel', version: '', license: 'Apache-2.0', text: text('../LICENSE') }]
}

export async function bundleScript(entry, define = {}) {
  const bundled = await build({
    entryPoints: [here(entry).pathname],
    bundle: true, minify: true, write: false, format: 'iife', target: 'es2022', legalComments: 'none', charset: 'ascii', define,
  })
  const script = bundled.outputFiles[0].text.trimEnd()
  if (/<\/script|<!--/i.test(script)) throw new Error('the bundle would end its own element')
  return script
}
export async function bundleStyle(entry) {
  const styles = await build({ entryPoints: [here(entry).pathname], bundle: true, minify: true, write: false, charset: 'ascii' })
  return styles.outputFiles[0].text.trimEnd()
}

export const hashOf = (script) => `'sha256-${createHash('sha256').update(script).digest('base64')}'`

// In pieces, to limit the length of source lines.
export function literal(string) {
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

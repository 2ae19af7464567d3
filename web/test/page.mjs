// Reads a report's file without a browser.
import { execFileSync, spawnSync } from 'node:child_process'
import { readFileSync } from 'node:fs'
import { inflateSync } from 'node:zlib'
import { Run } from '../src/run.js'

export function readPage(file) {
  const html = readFileSync(file, 'latin1')
  const parts = new Map()
  for (const [, name, text] of html.matchAll(/<script type="text\/plain" data-stream="([^"]+)">([^<]*)<\/script>/g)) {
    if (!parts.has(name)) parts.set(name, [])
    parts.get(name).push(Buffer.from(text, 'base64'))
  }
  const streams = new Map([...parts].map(([name, list]) => [name, new Uint8Array(inflateSync(Buffer.concat(list)))]))
  const facts = JSON.parse(Buffer.from(html.match(/id="facts">([^<]*)</)[1], 'latin1').toString('utf8'))
  return { bytes: html.length, streams, facts, run: new Run(streams, facts) }
}

// Returns standard output and error; the exit status must be 0.
export function trammel(command, ...options) {
  return execFileSync(command, options, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'], maxBuffer: 1 << 28 })
}
// For a run that is stopped: the status must be 1; returns the messages.
export function trammelStops(command, ...options) {
  const { status, stderr } = spawnSync(command, options, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] })
  if (status !== 1) throw new Error(`status ${status}: ${stderr}`)
  return stderr
}

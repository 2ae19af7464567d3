// The panel: shows the server's states, and sends it the requests of buttons and keys.
import { byId, make } from '../dom.js'
import { fixed, grouped } from '../format.js'
import { Program } from '../program.js'
import { isDark, setTheme } from '../theme.js'
import { Jogger } from './jog.js'
import { Link } from './link.js'
import { Path } from './path.js'

const kOld = 600     // ms without a state, after which the page says so
const kNotes = 100
const kMoves = ['Run', 'Jog', 'Home']
const kFeedChanges = [-10, -1, 0, 1, 10]
const kRapids = [[25, 25], [50, 50], [100, 0]]

const now = { axes: [], hello: null, state: null, program: 0, jogger: null, path: null, lines: null, at: 0 }
const text = (id, value) => { if (byId(id).textContent !== value) byId(id).textContent = value }
const kindOf = ({ state }) => state === 'Alarm' ? 'alarm' : /^(Hold|Door|Sleep)/.test(state) ? 'held' : kMoves.includes(state) ? 'moves' : 'stands'
// Grbl's names and sub-states in words.
const kStates = { Idle: 'Idle', Run: 'Runs', Jog: 'Jogs', Home: 'Homes', Alarm: 'Alarm', 'Hold:0': 'Held', 'Hold:1': 'Comes to a hold', Check: 'Check', Sleep: 'Sleeps', 'Door:0': 'Held', 'Door:2': 'Comes to a hold' }

let link = null

function connection(words, bad) {
  text('link', words)
  byId('link').classList.toggle('bad', bad)
  if (bad) now.jogger?.end()
  if (bad) document.documentElement.dataset.connected = 'false'
  enable()
}

function greet(hello) {
  now.hello = hello
  now.axes = hello.axes
  byId('axes').replaceChildren(...hello.axes.map(({ letter, unit }, n) => make('tr', {},
    make('th', { scope: 'row', class: 'axis' }, letter, make('small', { id: `switch-${letter}` })),
    ...['work', 'machine'].map((what) => make('td', { class: `number ${what}` }, make('span', { id: `${what}-${letter}` }, '–'), make('small', {}, unit))),
    make('td', {}, make('button', { type: 'button', id: `zero-${letter}`, 'aria-label': `Set work zero of ${letter} here`, onclick: () => link.send('zero', { axis: n }) }, `Zero ${letter}`)))))
  now.jogger?.end()
  if (!now.jogger) now.jogger = new Jogger(link, hello.axes)
  if (!now.path) now.path = new Path(byId('path'), byId('views'), hello.axes)
  byId('when-gone').checked = hello.hold_when_gone
  document.documentElement.dataset.connected = 'true'
}

function show(state) {
  now.state = state
  now.at = Date.now()
  text('state', kStates[state.state] ?? state.state)
  byId('state').dataset.kind = kindOf(state)
  text('speed', `${grouped(state.speed_mm_per_min)} mm/min`)
  text('link', 'Connected')
  byId('link').classList.remove('bad')
  for (const [n, { letter }] of now.axes.entries()) {
    const axis = state.axes[n]
    text(`work-${letter}`, fixed(axis.work, 3))
    text(`machine-${letter}`, fixed(axis.machine, 3))
    text(`switch-${letter}`, axis.at_switch ? 'limit switch' : '')
  }
  const limits = now.axes.filter((_, n) => state.axes[n].min !== null || state.axes[n].max !== null).map(({ letter }) => letter)
  text('homed', `${now.hello.can_home ? (state.homed ? 'Homed' : 'Not homed') : 'No home switches'}. Soft limits ${limits.length ? `of ${limits.join(', ')} are on` : 'are off'}.`)
  text('feed', `${state.feed_override_percent} %`)
  text('rapid', `${state.rapid_override_percent} %`)
  showAlarm(state)
  showProgram(state.program)
  for (const note of state.notes ?? []) say(note)
  now.jogger.state(state)
  now.path.add(state.axes)
  enable()
}

function placeOf({ axes }) {
  return now.axes.map(({ letter, unit }, n) => `${letter} ${fixed(axes[n].machine, 3)} ${unit}`).join(', ')
}

function showAlarm(state) {
  const { alarm } = state
  byId('alarm').hidden = !alarm
  if (!alarm) return
  text('alarm-text', alarm.number ? `Alarm ${alarm.number}: ${alarm.text}` : alarm.text)
  text('alarm-reason', alarm.reason)
  const line = state.program.phase === 'stopped' && state.program.line ? ` The program was at line ${state.program.line}.` : ''
  text('alarm-place', `The machine stands at ${placeOf(state)} (machine coordinates).${line}`)
}

function showProgram(program) {
  const line = program.line ? `line ${program.line} of ${program.lines}` : `${program.lines} lines`
  const words = {
    none: 'No program.', loading: 'Loading …', ready: `${program.name}: ready, ${line}`, checking: `${program.name}: checking …`, running: `${program.name}: ${line}`,
    done: `${program.name}: done`, stopped: `${program.name}: ${program.line ? `stopped at ${line}` : 'not started'}. ${program.stop_reason}`,
  }
  text('program-state', words[program.phase])
  byId('program-state').classList.toggle('bad', program.phase === 'stopped')
  const there = ['ready', 'checking', 'running', 'done', 'stopped'].includes(program.phase)
  byId('progress').hidden = byId('program').hidden = !there
  byId('progress').value = program.phase === 'done' ? 1 : program.line / Math.max(program.lines, 1)
  if (there && program.version !== now.program) fetchProgram(program.version)
  if (!there) now.program = 0
  now.lines?.highlight(program.line)
}

// The text comes from the server, because any page may have sent it.
async function fetchProgram(version) {
  now.program = version
  now.lines = null
  try {
    const program = (await link.program()).split('\n')
    if (now.program !== version) return
    const box = make('div', { class: 'lines' })
    byId('program').replaceChildren(box)
    now.lines = new Program(box, { program, firstPath: [] }, () => {})
  } catch {
    now.program = 0
  }
}

function say({ error, text: words }) {
  const list = byId('notes')
  const time = new Date().toLocaleTimeString([], { hour12: false })
  list.prepend(make('li', { class: error ? 'bad' : null }, make('time', {}, time), words))
  while (list.children.length > kNotes) list.lastChild.remove()
}

function enable() {
  const { state } = now
  const there = link.open && state !== null
  const kind = there ? kindOf(state) : 'away'
  const program = there ? state.program.phase : 'none'
  const free = kind === 'stands' && !['checking', 'running'].includes(program)
  const set = (id, on) => { byId(id).disabled = !on }
  set('hold', kind === 'moves')
  set('resume', kind === 'held')
  set('stop', there)
  set('recover', kind === 'alarm')
  for (const id of ['home', 'alarm-home']) set(id, there && now.hello.can_home && (free || kind === 'alarm'))
  byId('alarm-home').hidden = !now.hello?.can_home
  set('start', free && ['ready', 'done', 'stopped'].includes(program))
  set('file', free || kind === 'alarm')
  for (const { letter } of now.axes) set(`zero-${letter}`, free)
  for (const button of byId('pad').children) button.disabled = !(free || state?.state === 'Jog') || !there
}

async function choose({ target }) {
  const [file] = target.files
  target.value = ''
  if (file) link.sendProgram(file.name, await file.text())
}

// Space holds motion; without motion it has its usual effect. Escape always stops.
function keyDown(event) {
  const { target } = event
  const types = target.matches?.('select, textarea, input:not([type="checkbox"]):not([type="file"])')
  if (event.key === 'Escape') {
    link.send('stop')
    event.preventDefault()
  } else if (event.key === ' ' && now.state && kindOf(now.state) === 'moves') {
    if (!event.repeat) link.send('hold')
    event.preventDefault()
  } else if (!types && !event.ctrlKey && !event.altKey && !event.metaKey && now.jogger?.keyDown(event)) {
    event.preventDefault()
  }
}

function listen() {
  const press = (id, what) => byId(id).addEventListener('click', () => link.send(what))
  for (const id of ['hold', 'resume', 'stop', 'home', 'start']) press(id, id)
  press('recover', 'unlock')
  press('alarm-home', 'home')
  byId('file').addEventListener('change', choose)
  byId('when-gone').addEventListener('change', ({ target }) => link.send('when_gone', { hold: target.checked }))
  byId('feed-buttons').append(...kFeedChanges.map((change) => make('button', { type: 'button', 'aria-label': change ? `Feed override ${change > 0 ? 'plus' : 'minus'} ${Math.abs(change)} %` : 'Feed override 100 %', onclick: () => link.send('feed', { change }) }, change ? `${change > 0 ? '+' : '−'}${Math.abs(change)}` : '100 %')))
  byId('rapid-buttons').append(...kRapids.map(([percent, change]) => make('button', { type: 'button', 'aria-label': `Rapid override ${percent} %`, onclick: () => link.send('rapid', { change }) }, `${percent} %`)))
  // Handled before the button with the focus.
  window.addEventListener('keydown', keyDown, true)
  window.addEventListener('keyup', (event) => now.jogger?.keyUp(event), true)
  byId('theme').addEventListener('click', () => { setTheme(!isDark()); now.path?.draw() })
  setInterval(() => {
    if (!link.open || Date.now() - now.at < kOld) return
    text('link', 'The connection is slow')
    byId('link').classList.add('bad')
  }, 200)
}

const scheme = matchMedia('(prefers-color-scheme: dark)')
setTheme(scheme.matches)
scheme.addEventListener('change', ({ matches }) => { setTheme(matches); now.path?.draw() })
listen()
link = new Link({ hello: greet, state: show, change: connection })
link.connect()
window.panel = { now, link }

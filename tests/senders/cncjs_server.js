// cncjs' server (npm) sends a program to `trammel grbl` over a pseudo-terminal. The test is a client of that server,
// like its page: it opens the port, loads the program, runs it, holds it once and resumes. The card's path must be that
// of `trammel run`, and the machine must come to rest at the program's end.
//   node cncjs_server.js NODE_MODULES TRAMMEL PROGRAM
'use strict';

const { spawn, spawnSync } = require('child_process');
const fs = require('fs');
const http = require('http');
const os = require('os');
const path = require('path');

const [modules, trammel, program] = process.argv.slice(2);
const io = require(path.join(modules, 'socket.io-client'));
const LONGEST = 120000; // ms

const wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

function within(what, promise) {
  return Promise.race([promise, wait(LONGEST).then(() => { throw new Error(`${what} does not come`); })]);
}

function start(command, args, pattern) {
  const child = spawn(command, args, { stdio: ['ignore', 'pipe', 'pipe'] });
  child.said = '';
  const found = new Promise((resolve, reject) => {
    const read = (text) => {
      child.said += text;
      const match = pattern.exec(child.said);
      if (match) resolve(match);
    };
    child.stdout.on('data', read);
    child.stderr.on('data', read);
    child.once('exit', () => reject(new Error(`${command} has ended: ${child.said}`)));
  });
  return { child, found: within(command, found) };
}

function end(child) {
  return new Promise((resolve) => {
    child.removeAllListeners('exit');
    child.once('close', () => resolve(child.said));
    child.kill('SIGTERM');
  });
}

// "STEPS ORDER", as the card's server prints them at its end.
function pathOf(said) {
  const found = /path: (\d+) steps.*of axes and directions ([0-9a-f]{16})/.exec(said);
  return found ? `${found[1]} ${found[2]}` : said;
}

async function byRun() {
  const { child, found } = start(trammel, ['serve', '--engine', 'model', '--fast'], /--card '(\S+)'/);
  const url = (await found)[1];
  const run = spawnSync(trammel, ['run', program, '--card', url], { encoding: 'utf8' });
  if (run.status !== 0) throw new Error(run.stderr);
  return pathOf(await end(child));
}

function signIn(port) {
  return new Promise((resolve, reject) => {
    const request = http.request({ host: '127.0.0.1', port, path: '/api/signin', method: 'POST',
      headers: { 'Content-Type': 'application/json' } }, (response) => {
      let body = '';
      response.on('data', (part) => { body += part; });
      response.on('end', () => resolve(JSON.parse(body).token));
    });
    request.on('error', reject);
    request.end('{}');
  });
}

async function run(port, serial) {
  const token = await within('a token', signIn(port));
  const socket = io.connect(`http://127.0.0.1:${port}`, { query: `token=${token}`, transports: ['websocket'] });
  const next = (event, good = () => true) => within(event, new Promise((resolve) => {
    const listen = (...args) => {
      if (!good(...args)) return;
      socket.removeListener(event, listen);
      resolve(args);
    };
    socket.on(event, listen);
  }));
  await next('startup');
  const opened = next('serialport:open');
  socket.emit('open', serial, { baudrate: 115200, controllerType: 'Grbl' });
  await opened;
  const active = (state) => next('controller:state', (type, data) => data.status && data.status.activeState === state);
  await active('Idle');
  const loaded = next('gcode:load');
  socket.emit('command', serial, 'gcode:load', 'job', fs.readFileSync(program, 'utf8'), {});
  await loaded;
  const running = active('Run');
  socket.emit('command', serial, 'gcode:start');
  await running;
  const held = active('Hold');
  socket.emit('command', serial, 'feedhold');
  await held;
  const again = active('Run');
  const done = next('workflow:state', (state) => state === 'idle');
  socket.emit('command', serial, 'cyclestart');
  await again;
  await done;  // cncjs waits for Idle
  socket.close();
}

async function main() {
  const server = start(trammel, ['grbl', '--pty', '--engine', 'model'], /serial port (\S+)/);
  const serial = (await server.found)[1];
  const rc = path.join(fs.mkdtempSync(path.join(os.tmpdir(), 'trammel-cncjs-')), 'cncrc');
  fs.writeFileSync(rc, '{}');
  const port = 20000 + (process.pid % 20000);
  const cncjs = start(process.execPath, [path.join(modules, 'cncjs/bin/cncjs'), '-H', '127.0.0.1', '-p', String(port), '-c', rc],
    /Starting the server at \S+/);
  await cncjs.found;
  process.stdout.write(`cncjs at http://127.0.0.1:${port}, Grbl at ${serial}\n`);
  let failure = null;
  await run(port, serial).catch((error) => { failure = error; });
  await end(cncjs.child);
  const said = await end(server.child);
  const made = pathOf(said);
  const wanted = await byRun();
  process.stdout.write(`${!failure && made === wanted ? 'ok  ' : 'FAIL'} cncjs: ${made}, wanted ${wanted}${failure ? `; ${failure.message}` : ''}\n`);
  process.exit(!failure && made === wanted ? 0 : 1);
}

main().catch((error) => {
  process.stderr.write(`${error.stack}\n`);
  process.exit(1);
});

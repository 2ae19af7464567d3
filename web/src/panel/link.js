// The connection to the server: it sends messages and receives states. After a break it reconnects automatically, but
// sends nothing that moves the machine.
const kRetry = 1000      // ms
const kLongest = 65536   // most characters in a part of a program

export class Link {
  // on: { hello, state, change(text, bad) }
  constructor(on) {
    this.on = on
    this.clock = 0  // the server's clock in the last state, ms
    this.replaced = false
  }
  get open() { return this.socket?.readyState === WebSocket.OPEN }
  connect() {
    const address = new URL('socket', location.href)
    address.protocol = location.protocol === 'https:' ? 'wss:' : 'ws:'
    address.search = location.search
    this.on.change('Connecting …', true)
    const socket = this.socket = new WebSocket(address)
    socket.onmessage = ({ data }) => this.take(JSON.parse(data))
    socket.onclose = ({ reason }) => {
      if (this.socket !== socket) return
      this.replaced = reason === 'replaced'
      this.on.change(this.replaced ? 'Opened elsewhere' : 'No connection', true)
      if (!this.replaced) setTimeout(() => this.connect(), kRetry)
    }
  }
  take({ hello, state }) {
    if (hello) {
      this.on.change('Connected', false)
      this.on.hello(hello)
    }
    if (state) {
      this.clock = state.clock
      this.on.state(state)
    }
  }
  // False if there is no connection.
  send(what, values = {}) {
    if (!this.open) return false
    this.socket.send(JSON.stringify({ do: what, clock: this.clock, ...values }))
    return true
  }
  sendProgram(name, text) {
    this.send('load', { text: name })
    for (let at = 0; at < text.length;) {
      let end = Math.min(at + kLongest, text.length)
      // The two halves of a surrogate pair stay together.
      if (end < text.length && /[\ud800-\udbff]/.test(text[end - 1])) --end
      this.send('part', { text: text.slice(at, end) })
      at = end
    }
    this.send('loaded')
  }
  async program() {
    const answer = await fetch(`program${location.search}`)
    if (!answer.ok) throw new Error(`${answer.status}`)
    return answer.text()
  }
}

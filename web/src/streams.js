// The data in the page's own elements, as bytes.

const fromBase64 = Uint8Array.fromBase64
  ? (text) => Uint8Array.fromBase64(text)
  : (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0))

async function inflated(parts) {
  const stream = new Blob(parts).stream().pipeThrough(new DecompressionStream('deflate'))
  return new Uint8Array(await new Response(stream).arrayBuffer())
}

// All streams by name; removes their elements from the document.
export async function readStreams(document) {
  const parts = new Map()
  for (const element of document.querySelectorAll('script[data-stream]')) {
    const name = element.dataset.stream
    if (!parts.has(name)) parts.set(name, [])
    parts.get(name).push(fromBase64(element.textContent))
    element.remove()
  }
  const streams = new Map()
  await Promise.all([...parts].map(async ([name, list]) => streams.set(name, await inflated(list))))
  return streams
}

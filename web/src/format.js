// Formats numbers for people.

// The smallest of 1, 2 or 5 times a power of ten that is not below x.
export function niceStep(x) {
  const power = 10 ** Math.floor(Math.log10(x))
  for (const factor of [1, 2, 5, 10]) if (factor * power >= x * (1 - 1e-9)) return factor * power
  return 10 * power
}
export const decimals = (step) => Math.max(0, Math.min(12, -Math.floor(Math.log10(step) + 1e-9)))
export const fixed = (x, digits) => (Object.is(x, -0) || Math.abs(x) < 0.5 * 10 ** -digits ? 0 : x).toFixed(digits)

// About four digits, without an exponent.
export function number(x) {
  if (!Number.isFinite(x)) return '–'
  const size = Math.abs(x)
  if (size >= 1e6) return `${fixed(x / 1e6, size >= 1e8 ? 0 : 2)} M`
  if (size >= 1e4) return `${fixed(x / 1e3, size >= 1e5 ? 0 : 1)} k`
  if (size >= 100) return fixed(x, 0)
  if (size >= 10) return fixed(x, 1)
  if (size >= 1) return fixed(x, 2)
  return size === 0 ? '0' : fixed(x, 3)
}
export const grouped = (n) => String(Math.round(n)).replace(/\B(?=(\d{3})+$)/g, ' ')
export const millimetres = (x) => x < 1000 ? `${number(x)} mm` : `${grouped(x)} mm`
export function duration(seconds) {
  if (seconds < 1e-3) return `${number(seconds * 1e6)} µs`
  if (seconds < 1) return `${number(seconds * 1e3)} ms`
  if (seconds < 120) return `${fixed(seconds, 3)} s`
  const minutes = Math.floor(seconds / 60)
  const hours = Math.floor(minutes / 60)
  const rest = fixed(seconds - 60 * minutes, 1).padStart(4, '0')
  return hours ? `${hours}:${String(minutes % 60).padStart(2, '0')}:${rest} h` : `${minutes}:${rest} min`
}
// About `count` ticks of a scale, each a multiple of a round step.
export function ticks(from, to, count) {
  const step = niceStep((to - from) / count)
  const list = []
  for (let i = Math.ceil(from / step - 1e-9); i * step <= to + 1e-9 * step; ++i) list.push(i * step)
  return { step, list }
}

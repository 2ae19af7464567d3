// Colours: those of the style sheet, and ramps for the path.

let parsed = new Map()
export function colour(name) {
  if (!parsed.has(name)) parsed.set(name, getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim())
  return parsed.get(name)
}
export const axisColour = (letter) => colour({ X: 'x', Y: 'y', Z: 'z', E: 'e', U: 'u', V: 'v', W: 'w' }[letter] ?? 'a')

export const isDark = () => document.documentElement.dataset.theme === 'dark'
export function setTheme(dark) {
  document.documentElement.dataset.theme = dark ? 'dark' : 'light'
  parsed = new Map()
}

// From slow to fast, visible on both backgrounds: blue, teal, green, yellow or orange, red.
const ramps = {
  light: [[49, 54, 149], [33, 113, 181], [0, 137, 123], [92, 160, 41], [230, 145, 20], [204, 40, 48]],
  dark: [[98, 110, 235], [70, 150, 245], [40, 190, 185], [130, 205, 80], [250, 190, 60], [255, 95, 85]],
}
export function ramp(share, out = [0, 0, 0]) {
  const stops = isDark() ? ramps.dark : ramps.light
  const at = Math.min(Math.max(share, 0), 1) * (stops.length - 1)
  const i = Math.min(Math.floor(at), stops.length - 2)
  for (let c = 0; c < 3; ++c) out[c] = (stops[i][c] + (at - i) * (stops[i + 1][c] - stops[i][c])) / 255
  return out
}
export function rampCss() {
  const stops = isDark() ? ramps.dark : ramps.light
  return `linear-gradient(90deg, ${stops.map((c) => `rgb(${c.join(' ')})`).join(', ')})`
}

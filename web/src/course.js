// The commanded path as corners of lines, with the values for their colours. Does not use the document.
import { kArc, kPause, kSpaceArc } from './decode.js'

const kMaxCorners = 300000  // corners

// Pairs of corners (x y z, mm from the run's middle), in two lists: feed moves and rapids.
export function courseOf(run) {
  const { motion, paths, centre } = run
  const perStretch = Math.max(1, Math.min(16, Math.floor(kMaxCorners / Math.max(1, motion.count))))
  const feed = { points: [], speed: [], load: [], deviation: [], path: [] }
  const rapid = { points: [], path: [] }
  // Lines of a long program are shorter than a pixel, so corners closer than this to the previous one are left out.
  const least = motion.count > kMaxCorners ? extentOf(run) / 4000 : 0
  let last = null, lastPath = -1
  for (let s = 0; s < motion.count; ++s) {
    const path = motion.paths[s]
    if (paths.lengths[path] === 0) continue
    const clocks = motion.begins[s + 1] - motion.begins[s]
    const isRapid = (paths.flags[path] & 4) !== 0
    const arc = paths.arcs.get(path)
    const begin = run.shareAt(s, 0), end = run.shareAt(s, clocks)
    let parts = motion.accelerations[s] !== 0 || motion.jerks[s] !== 0 ? Math.min(8, perStretch) : 1
    if (arc) parts = Math.max(parts, Math.ceil(Math.abs(arc.sweep * (end[0] - begin[0])) / 0.06))
    const corner = (share) => {
      const at = run.pointAt(path, Math.min(1, share[0])).map((x, i) => x - centre[i])
      return { at, speed: run.pathSpeed(path, share[1]), load: run.loadAt(path, share) }
    }
    let before = corner(begin)
    if (least > 0 && last && lastPath !== path && Math.hypot(...before.at.map((x, i) => x - last.at[i])) < least) before = last
    for (let i = 1; i <= parts; ++i) {
      const now = corner(i === parts ? end : run.shareAt(s, clocks * i / parts))
      if (least > 0 && Math.hypot(...now.at.map((x, c) => x - before.at[c])) < least && s + 1 < motion.count) continue
      const to = isRapid ? rapid : feed
      to.points.push(...before.at, ...now.at)
      to.path.push(path)
      if (!isRapid) {
        to.speed.push(before.speed, now.speed)
        to.load.push(before.load, now.load)
        to.deviation.push(run.pathDeviation[path], run.pathDeviation[path])
      }
      before = now
    }
    last = before
    lastPath = path
  }
  return { feed, rapid }
}

// The largest side of the bounding box of all points, mm.
function extentOf(run) {
  const { low, high } = boxOf(run, false)
  return Math.max(...high.map((x, i) => x - low[i]), 1e-6)
}

// The bounding box of the commanded path, mm from the run's middle; an arc is approximated by eight points.
export function boxOf(run, withArcs = true) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity]
  const take = (at) => at.forEach((x, i) => {
    low[i] = Math.min(low[i], x - run.centre[i])
    high[i] = Math.max(high[i], x - run.centre[i])
  })
  take(run.space.map((axis) => axis < 0 ? 0 : run.startCoordinate(axis)))
  for (let p = 0; p < run.paths.count; ++p) {
    const kind = run.paths.flags[p] & 3
    if (kind === kPause) continue
    take(run.pointAt(p, 1))
    if (withArcs && (kind === kArc || kind === kSpaceArc)) for (let i = 0; i < 8; ++i) take(run.pointAt(p, i / 8))
  }
  return { low, high }
}

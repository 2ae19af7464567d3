// Reduces a path to few lines, to be drawn while the view moves. Does not use the document.

// Pairs of corners (indices into a list of x y z), about `most` lines at most: each line joins several consecutive
// ones.
export function outline(points, most) {
  const lines = points.length / 6
  const run = Math.max(1, Math.ceil(lines / most))
  const joined = (line) => [0, 1, 2].every((d) => points[6 * line - 3 + d] === points[6 * line + d])
  const corners = []
  for (let begin = 0; begin < lines;) {
    let end = begin + 1
    while (end < lines && end - begin < run && joined(end)) ++end
    corners.push(2 * begin, 2 * end - 1)
    begin = end
  }
  return Uint32Array.from(corners)
}

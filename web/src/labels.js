// Places for labels that must not cover one another: a label takes the first of its places that is free, and is left out where none is.

export class Labels {
  constructor(width, height) {
    this.width = width
    this.height = height
    this.taken = []  // boxes: left, top, right, bottom
  }
  take(box) { this.taken.push(box) }
  // Takes one of the boxes: the first that is free and covers none of the others, else the first that is free; undefined where none is.
  place(boxes, others = []) {
    const free = boxes.filter((box) => this.within(box) && !meets(box, this.taken))
    const box = free.find((one) => !meets(one, others)) ?? free[0]
    if (box) this.take(box)
    return box
  }
  within([left, top, right, bottom]) { return left >= 0 && top >= 0 && right <= this.width && bottom <= this.height }
}

const meets = (box, others) => others.some((other) => box[0] < other[2] && other[0] < box[2] && box[1] < other[3] && other[1] < box[3])

// Places for labels that must not cover each other: a label takes the first free one of its places, or is left out if
// there is none.

export class Labels {
  constructor(width, height) {
    this.width = width
    this.height = height
    this.taken = []  // boxes: left, top, right, bottom
  }
  take(box) { this.taken.push(box) }
  // Takes one of the boxes: the first free one that covers none of the others, else the first free one; undefined if
  // none is free.
  place(boxes, others = []) {
    const free = boxes.filter((box) => this.within(box) && !meets(box, this.taken))
    const box = free.find((one) => !meets(one, others)) ?? free[0]
    if (box) this.take(box)
    return box
  }
  within([left, top, right, bottom]) { return left >= 0 && top >= 0 && right <= this.width && bottom <= this.height }
}

const meets = (box, others) => others.some((other) => box[0] < other[2] && other[0] < box[2] && box[1] < other[3] && other[1] < box[3])

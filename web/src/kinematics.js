// Converts between the motors' pulses and the machine's axes, with the ratios in the report's facts. Does not use the
// document.

export class Kinematics {
  constructor({ motors, axes }) {
    const joints = motors.slice(0, axes)  // second motors follow the first ones
    this.forward = joints.map((motor) => motor.pulses_per_mm)  // indexed by motor and axis
    // For each axis, the motors that move it, with the mm of one pulse.
    this.inverse = joints.map((_, axis) => joints
      .map((motor, m) => ({ motor: m, mm: motor.mm_per_pulse[axis] })).filter(({ mm }) => mm !== 0))
    this.names = motors.map(({ pulses_per_mm: ratios, axis }, m) => nameOf(ratios, joints) + (m === axis ? '' : ' 2nd motor'))
  }
  // Position of an axis, mm; `pulses` returns those of a motor.
  coordinate(axis, pulses) {
    let sum = 0
    for (const { motor, mm } of this.inverse[axis]) sum += pulses(motor) * mm
    return sum
  }
  hasOwnMotor(axis) { return this.inverse[axis].length === 1 }
  // mm by which one pulse moves an axis.
  pulseOf(axis) { return Math.min(...this.inverse[axis].map(({ mm }) => Math.abs(mm))) }
  // The two motors for which an arc is also a circle in pulses, and its centre in pulses, as in the card; otherwise
  // null.
  circle({ plane: [x, y], centre }) {
    const motors = this.forward.map((_, m) => m).filter((m) => this.forward[m][x] !== 0 || this.forward[m][y] !== 0)
    if (motors.length !== 2) return null
    const [[a, b], [c, d]] = motors.map((m) => [this.forward[m][x], this.forward[m][y]])
    if (a * b + c * d !== 0 || a * a + c * c !== b * b + d * d) return null
    const units = (pulses) => Math.sign(pulses) * Math.round(256 * Math.abs(pulses)) / 256
    return { motors, at: [units(a * centre[0] + b * centre[1]), units(c * centre[0] + d * centre[1])] }
  }
}

// "X", or with crossed belts "X − Y".
function nameOf(ratios, joints) {
  const terms = ratios.map((ratio, axis) => ({ ratio, letter: joints[axis].letter })).filter(({ ratio }) => ratio !== 0)
  return terms.map(({ ratio, letter }, i) => (ratio < 0 ? i ? ' − ' : '−' : i ? ' + ' : '') + letter).join('')
}

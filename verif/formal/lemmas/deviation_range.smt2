; expect: sat unsat unsat unsat sat
; How far a coordinate goes until the walk turns straight to its end. Ellipse with semi-axes (p, q) in lattice units, one
; pulse = `unit` of them: F = q^2 x^2 + p^2 y^2 - p^2 q^2 with any positive common factor. A step outward is made only
; while F < 0, a step inward brings the coordinate nearer to zero, or over it by less than a pulse.
(set-logic ALL)
(declare-const p Real)
(declare-const q Real)
(declare-const x Real)
(declare-const y Real)
(declare-const unit Real)
(assert (and (<= unit p) (<= unit q) (< 0.0 unit)))
(define-fun inside () Bool (< (+ (* (* q x) (* q x)) (* (* p y) (* p y))) (* (* p q) (* p q))))
(push) (assert (and (= p 5.0) (= q 3.0) (= x 1.0) (= y 2.0) (= unit 1.0))) (assert inside) (check-sat) (pop)
; Outward: inside means |y| < q, so |y| < q + unit afterwards.
(push) (assert inside) (assert (not (< (* (* p y) (* p y)) (* (* p q) (* p q))))) (check-sat) (pop)
(push) (assert (and (< 0.0 p) (<= 0.0 y) (<= q y) (< (* (* p y) (* p y)) (* (* p q) (* p q))))) (check-sat) (pop)
; Inward: from 0 <= y to y - unit.
(push) (assert (and (<= 0.0 y) (<= y (+ q unit)))) (assert (not (and (<= (- y unit) (+ q unit)) (<= (- (+ q unit)) (- y unit)))))
(check-sat) (pop)
; Seeded: outward steps while F <= 0 would reach q + unit itself.
(push) (assert (and (= p 5.0) (= q 3.0) (= x 0.0) (= y 3.0) (= unit 1.0)))
(assert (<= (+ (* (* q x) (* q x)) (* (* p y) (* p y))) (* (* p q) (* p q)))) (assert (not (< (+ y unit) (+ q unit))))
(check-sat) (pop)

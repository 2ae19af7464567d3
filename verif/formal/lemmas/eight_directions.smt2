; expect: sat unsat unsat unsat sat sat unsat unsat sat
; The 8-direction rule over the integers. One axis moves inward: its step changes F by ui = h - |G|; the other one
; outward: uo = h' + |G'|. Both, inward alone, outward alone: f + ui + uo, f + ui, f + uo.
(set-logic ALL)
(declare-const f Int)
(declare-const gi Int) ; |G| of the inward axis, and of the outward one
(declare-const go Int)
(declare-const hi Int) ; CX/2 of theirs
(declare-const ho Int)
(assert (and (<= 0 gi) (<= 0 go) (< 0 hi) (< 0 ho)))
(define-fun ui () Int (- hi gi))
(define-fun uo () Int (+ ho go))
(define-fun inward_alone () Bool (>= (+ f ui f ui uo) 0))
(define-fun outward_alone () Bool (and (not inward_alone) (< (+ f uo f ui uo) 0)))
(define-fun size ((v Int)) Int (ite (< v 0) (- v) v))
(define-fun taken () Int (size (ite inward_alone (+ f ui) (ite outward_alone (+ f uo) (+ f ui uo)))))
; Circle of radius 25 at (25, 0): outward alone.
(push) (assert (and (= f 0) (= gi 50) (= go 0) (= hi 1) (= ho 1))) (assert outward_alone) (check-sat) (pop)
; The least |F| of the three, unless the inward axis is within half a pulse of its zero.
(push) (assert (<= hi gi)) (assert (> taken (size (+ f ui)))) (check-sat) (pop)
(push) (assert (<= hi gi)) (assert (or (> taken (size (+ f uo))) (> taken (size (+ f ui uo))))) (check-sat) (pop)
; The guard: on and outside the curve the outward axis never steps alone where its gradient is the larger one.
(push) (assert (and (>= f 0) outward_alone (> go gi))) (check-sat) (pop)
; Seeded: without "on and outside", and without the half pulse, both may be.
(push) (assert (and outward_alone (> go gi))) (check-sat) (pop)
(push) (assert (> taken (size (+ f uo)))) (check-sat) (pop)
; Range (x inward, y outward, both magnitudes in pulses; F = A x^2 + B y^2 - B q^2, q the semi-axis): a step outward is
; made, alone or not, only where 2 F + 2 ui + uo < 0, and that is y + 1/2 < q: no coordinate goes half a pulse beyond.
(declare-const a Real)
(declare-const b Real)
(declare-const x Real)
(declare-const y Real)
(declare-const q Real)
(declare-const square Real) ; A (x - 1)^2
(assert (and (<= 0.0 square) (< 0.0 b) (<= 0.0 y) (<= 1.0 q)))
(define-fun sum () Real (+ (* 2.0 (- (+ (* a x x) (* b y y)) (* b q q))) (* 2.0 (- a (* 2.0 a x))) (+ b (* 2.0 b y))))
(define-fun rest () Real (* b (- (+ (* (+ y 0.5) (+ y 0.5)) 0.25) (* q q))))
(push) (assert (not (= sum (* 2.0 (+ (* a (- x 1.0) (- x 1.0)) rest))))) (check-sat) (pop)
(push) (assert (< (+ square rest) 0.0)) (assert (>= (+ y 0.5) q)) (check-sat) (pop)
; Seeded: half a pulse less is not so.
(push) (assert (< (+ square rest) 0.0)) (assert (>= (+ y 1.0) q)) (check-sat) (pop)

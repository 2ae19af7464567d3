; expect: sat unsat unsat sat
; Two axes each within d of their ideal place: the point is within sqrt(2) d of the line with direction (c, s).
(set-logic ALL)
(declare-const u Real)
(declare-const v Real)
(declare-const c Real)
(declare-const s Real)
(declare-const d Real)
(define-fun across () Real (- (* u s) (* v c)))
(define-fun along () Real (+ (* u c) (* v s)))
; Cover: nearly the bound, on the 3-4-5 line.
(push) (assert (= d 1.0)) (assert (= u 1.0)) (assert (= v (- 1.0))) (assert (= c (/ 3 5))) (assert (= s (/ 4 5)))
(assert (> (* across across) 1.9)) (check-sat) (pop)
; across^2 + along^2 = (u^2 + v^2)(c^2 + s^2), an identity, so across^2 <= u^2 + v^2 for a unit direction ...
(push) (assert (not (= (+ (* across across) (* along along)) (* (+ (* u u) (* v v)) (+ (* c c) (* s s))))))
(check-sat) (pop)
; ... <= 2 d^2.
(push) (assert (and (<= (- d) u) (<= u d) (<= (- d) v) (<= v d))) (assert (> (+ (* u u) (* v v)) (* 2 d d)))
(check-sat) (pop)
; Seeded: d itself is no bound.
(push) (assert (= d 1.0)) (assert (= u 1.0)) (assert (= v (- 1.0))) (assert (= c (/ 3 5))) (assert (= s (/ 4 5)))
(assert (not (<= (* across across) (* d d)))) (check-sat) (pop)

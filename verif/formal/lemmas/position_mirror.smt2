; expect: sat unsat sat
; A mirrored line (preset one half less 2^-40, increment below 0) stands at minus the position of its mirror image.
(set-logic ALL)
(define-fun one () Int 1099511627776)
(define-fun half () Int 549755813888)
(declare-const travel Int) ; k |increment|
(declare-const x Int)
(declare-const phase Int)
(declare-const mirror_x Int)
(declare-const mirror_phase Int)
(declare-const preset Int)
(assert (and (<= 0 travel) (<= 0 phase) (< phase one) (<= 0 mirror_phase) (< mirror_phase one)))
(assert (= (+ (* one x) phase) (+ half travel)))
(assert (= (+ (* one mirror_x) mirror_phase) (- preset travel)))
(push) (assert (= preset (- half 1))) (assert (< 5 x)) (check-sat) (pop)
(push) (assert (= preset (- half 1))) (assert (not (= mirror_x (- x)))) (check-sat) (pop)
; Seeded: without the 2^-40 the image differs.
(push) (assert (= preset half)) (assert (not (= mirror_x (- x)))) (check-sat) (pop)

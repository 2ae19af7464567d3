; expect: sat unsat unsat sat
; After L < 2^40 ticks x = p exactly, with the preset one half as with one half less 2^-40.
(set-logic ALL)
(define-fun one () Int 1099511627776)
(define-fun half () Int 549755813888)
(declare-const p Int)
(declare-const l Int)
(declare-const increment Int)
(declare-const x Int)
(declare-const phase Int)
(declare-const preset Int)
(declare-const e Int)
(assert (and (< 0 l) (<= 0 phase) (< phase one) (<= (* 2 e) l) (<= (- l) (* 2 e))))
(assert (or (= preset half) (= preset (- half 1))))
; Cover: a line with a rest.
(push) (assert (= l 3)) (assert (= p 2)) (assert (= increment 733007751851)) (assert (= e (- (* increment l) (* p one))))
(assert (= (+ (* one x) phase) (+ preset (* l increment)))) (check-sat) (pop)
; With k = L the sum of the increments is 2^40 p + e, since e = increment L - 2^40 p: nothing else is left of the line.
(push) (assert (= e (- (* increment l) (* p one))))
(assert (not (= (+ preset (* l increment)) (+ preset (* p one) e)))) (check-sat) (pop)
(assert (= (+ (* one x) phase) (+ preset (* p one) e)))
(push) (assert (< l one)) (assert (not (= x p))) (check-sat) (pop)
; Seeded: L = 2^40 may miss.
(push) (assert (= l one)) (assert (not (= x p))) (check-sat) (pop)

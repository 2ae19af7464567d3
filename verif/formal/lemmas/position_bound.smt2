; expect: sat unsat unsat unsat unsat sat
; |x_k - p k/L| <= 1/2 + k/2^41 for a line of p pulses in L ticks, increment = p 2^40 / L rounded to nearest.
; The generator proves (by induction, verif/formal/pulse_generator.properties): 2^40 x + phase = 2^39 + k increment.
(set-logic ALL)
(define-fun one () Int 1099511627776)
(define-fun half () Int 549755813888)
(declare-const p Int)
(declare-const l Int)
(declare-const increment Int)
(declare-const k Int)
(declare-const x Int)
(declare-const phase Int)
(define-fun e () Int (- (* increment l) (* p one)))
(assert (and (< 0 l) (<= 0 k) (<= k l) (<= 0 phase) (< phase one)))
(assert (and (<= (* 2 e) l) (<= (- l) (* 2 e))))
; Cover: such a line exists.
(push) (assert (= p 2 k)) (assert (= l 3)) (assert (= increment 733007751851))
(assert (= (+ (* one x) phase) (+ half (* k increment)))) (check-sat) (pop)
; The error in units of 1/(2^40 L) has two parts, the phase's and the increment's ...
(push)
(assert (not (= (- (* l (- (+ half (* k increment)) phase)) (* one p k)) (+ (* l (- half phase)) (* k e)))))
(check-sat) (pop)
; ... each with its bound: a bound less its part is a product of two numbers that are not negative ...
(push)
(assert (not (and (= (- (* l one) (* 2 l (- half phase))) (* 2 l phase))
                  (= (+ (* l one) (* 2 l (- half phase))) (* 2 l (- one phase)))
                  (= (- (* k l) (* 2 k e)) (* k (- l (* 2 e))))
                  (= (+ (* k l) (* 2 k e)) (* k (+ l (* 2 e)))))))
(check-sat) (pop)
(declare-const factor Int) (declare-const other Int)
(push) (assert (and (<= 0 factor) (<= 0 other) (< (* factor other) 0))) (check-sat) (pop)
; ... which add up (products as variables: u = L (half - phase), w = k e, kl = k L, xl = x L, pk = p k).
(declare-const u Int) (declare-const w Int) (declare-const kl Int) (declare-const xl Int) (declare-const pk Int)
(define-fun error () Int (* 2 one (- xl pk)))
(assert (and (= (- (* one xl) (* one pk)) (+ u w)) (<= (* 2 u) (* l one)) (<= (- (* l one)) (* 2 u))
             (<= (* 2 w) kl) (<= (- kl) (* 2 w))))
(push) (assert (not (and (<= error (+ (* l one) kl)) (<= (- (+ (* l one) kl)) error)))) (check-sat) (pop)
; Seeded: the phase's part alone is no bound.
(push) (assert (= l 3)) (assert (not (<= error (* l one)))) (check-sat) (pop)

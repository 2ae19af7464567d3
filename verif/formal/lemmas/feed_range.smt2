; expect: sat unsat unsat unsat sat
; R and A of the feed generator stay within the +-8 of their bits. r0, r1, r2 are three Rs of a piece in a row, a0 and a1 what is
; added to the first two, j the jerk: an update makes r + a and a + j, and none follows once R lies outside -2 .. 2.
(set-logic ALL)
(declare-const r0 Real)
(declare-const r1 Real)
(declare-const a0 Real)
(declare-const j Real)
(define-fun in ((r Real)) Bool (and (<= (- 2.0) r) (< r 2.0)))
(define-fun fits ((v Real)) Bool (and (<= (- 8.0) v) (< v 8.0)))
(define-fun halved ((v Real)) Bool (and (<= (- 0.5) v) (< v 0.5)))
(define-fun a1 () Real (+ a0 j))
(assert (halved j))
; A piece that ends outside, and what it takes to get there.
(push) (assert (and (in r0) (= r1 (+ r0 a0)) (in r1) (not (in (+ r1 a1))))) (check-sat) (pop)
; The first update of a piece: 0 <= R < 1, A of half.
(push) (assert (and (<= 0.0 r0) (< r0 1.0) (halved a0))) (assert (not (and (fits (+ r0 a0)) (fits a1)))) (check-sat) (pop)
; Any later one: the R before was inside too, so A is the difference of two.
(push) (assert (and (in r0) (= r1 (+ r0 a0)) (in r1))) (assert (not (and (fits (+ r1 a1)) (fits (+ a1 j))))) (check-sat) (pop)
(push) (assert (and (in r0) (= r1 (+ r0 a0)) (in r1))) (assert (not (and (< (- 4.5) a1) (< a1 4.5)))) (check-sat) (pop)
; Seeded: without the stop outside -2 .. 2 they do not.
(push) (assert (and (fits r0) (= r1 (+ r0 a0)) (fits r1))) (assert (not (fits (+ r1 a1)))) (check-sat) (pop)

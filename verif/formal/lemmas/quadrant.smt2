; expect: sat unsat unsat unsat sat unsat sat
; Within a quadrant (u: coordinate that moves towards zero while F >= 0, v: the one that moves outward while F < 0; both
; as magnitudes, A, B their CX/2): once between its neighbours the walk stays there, that is (u + 1, v) is on or outside
; the curve and (u, v - 1) inside, so the curve passes within one pulse of every point on the path.
(set-logic ALL)
(declare-const a Int)
(declare-const b Int)
(declare-const f Int)
(declare-const gu Int) ; 2 A u
(declare-const gv Int) ; 2 B v
(define-fun outside ((f Int) (gu Int)) Bool (>= (+ f gu a) 0))
(define-fun inside ((f Int) (gv Int)) Bool (< (+ (- f gv) b) 0))
(define-fun between ((f Int) (gu Int) (gv Int)) Bool (and (outside f gu) (inside f gv)))
; A step inward leaves u >= 0; the step over zero is looked at below.
(assert (and (< 0 a) (< 0 b) (<= 0 gu) (<= 0 gv)))
(push) (assert (and (= a 1) (= b 1) (= gu 36) (= gv 36) (= f 23))) (assert (between f gu gv)) (check-sat) (pop)
(push) (assert (between f gu gv)) (assert (>= f 0)) (assert (<= (* 2 a) gu))
(assert (not (between (+ (- f gu) a) (- gu (* 2 a)) gv))) (check-sat) (pop)
(push) (assert (between f gu gv)) (assert (< f 0)) (assert (not (between (+ f gv b) gu (+ gv (* 2 b))))) (check-sat) (pop)
; Over zero (whole centre: from u = 0): v becomes the inward coordinate. One step later at most the walk is between its
; neighbours again: the step itself is at most one pulse to the side of a point that was.
(define-fun f1 () Int (+ f a))
(define-fun f2 () Int (+ (- f1 gv) b))
(push) (assert (between f gu gv)) (assert (= gu 0)) (assert (>= f 0)) (assert (<= (* 2 b) gv))
(assert (not (and (>= f1 0) (< f2 a) (>= (+ f2 (- gv (* 2 b)) b) 0) (< (+ (- f2 (* 2 a)) a) 0)))) (check-sat) (pop)
; Seeded: the other choice leaves the band.
(push) (assert (between f gu gv)) (assert (< f 0)) (assert (<= (* 2 a) gu))
(assert (not (between (+ (- f gu) a) (- gu (* 2 a)) gv))) (check-sat) (pop)
; Number of steps: u - v falls by exactly one a step, so a quadrant entered at (u0, v0) and left at (u1, v1) takes
; (u0 - u1) + (v1 - v0) steps, and no more than u0 + q + 1 since v1 <= q + 1 (lemma deviation_range).
(declare-const u Int)
(declare-const v Int)
(declare-const inward Bool)
(define-fun u1 () Int (ite inward (- u 1) u))
(define-fun v1 () Int (ite inward v (+ v 1)))
(push) (assert (not (= (- u1 v1) (- (- u v) 1)))) (check-sat) (pop)
(push) (assert (= (- u1 v1) 0)) (assert inward) (check-sat) (pop)

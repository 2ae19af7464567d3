; expect: sat unsat unsat sat
; A step of s in x keeps F = A x^2 + B y^2 - N and GX = 2 A x (A = CX/2 > 0; circle A = B; y by symmetry). Steps of
; +1 and -1 lattice points; a lattice finer than the pulse only scales A.
(set-logic ALL)
(declare-const a Int)
(declare-const b Int)
(declare-const n Int)
(declare-const x Int)
(declare-const y Int)
(declare-const s Int)
(define-fun f ((x Int) (y Int)) Int (- (+ (* a x x) (* b y y)) n))
(define-fun gx ((x Int)) Int (* 2 a x))
(assert (or (= s 1) (= s (- 1))))
(push) (assert (and (= a 4) (= b 9) (= n 36) (= x 2) (= y 1) (= s 1))) (assert (> (f (+ x s) y) 0)) (check-sat) (pop)
(push) (assert (= s 1))
(assert (not (and (= (f (+ x 1) y) (+ (f x y) (gx x) a)) (= (gx (+ x 1)) (+ (gx x) (* 2 a)))))) (check-sat) (pop)
(push) (assert (= s (- 1)))
(assert (not (and (= (f (- x 1) y) (+ (- (f x y) (gx x)) a)) (= (gx (- x 1)) (- (gx x) (* 2 a)))))) (check-sat) (pop)
; Seeded: without CX/2 the forms part.
(push) (assert (and (= a 4) (= b 9) (= n 36) (= x 2) (= y 1) (= s 1)))
(assert (not (= (f (+ x s) y) (+ (f x y) (* s (gx x)))))) (check-sat) (pop)

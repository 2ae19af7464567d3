; expect: sat unsat unsat unsat sat
; The host's conics against the 2^76 that the proof of the accumulator assumes of |F| at the start and of |G| until the
; end is in sight. Gradient of a conic: 2 A |x| unit, |x| <= semi-axis + one pulse (lemma deviation_range).
(set-logic ALL)
(define-fun limit () Int 75557863725914323419136) ; 2^76
(declare-const p Int)
(declare-const q Int)
(define-fun ellipse () Bool (and (<= 1 p) (<= 1 q) (<= p 1048576) (<= q 1048576)))
(push) (assert ellipse) (assert (= p 1048576)) (assert (= q 1048576)) (check-sat) (pop)
; Ellipse, semi-axes to 2^20: GX = 2 q^2 x with |x| <= p + 1, |F| < 4 p q max(p, q) (driver's check of the start).
(push) (assert (and ellipse (>= (* 2 (* q q) (+ p 1)) limit))) (check-sat) (pop)
(push) (assert (and ellipse (>= p q) (>= (* 4 (* p q) p) limit))) (check-sat) (pop)
; Circle about a centre with 8 fraction bits, coordinates to 2^24 pulses = 2^32 units: GX = 2 x 256, and a start within
; d <= 256 units of the radius r has |F| = |x^2 + y^2 - r^2| <= d (2 r + d) + 2^15 (half a square pulse).
(declare-const r Int)
(push) (assert (and (<= 256 r) (<= r 6074001001)))
(assert (or (>= (* 2 256 (+ 4294967296 256)) limit) (>= (+ (* 256 (+ (* 2 r) 256)) 32768) limit))) (check-sat) (pop)
; Seeded: semi-axes to 2^26 would not fit.
(push) (assert (= p 67108864)) (assert (= q 67108864)) (assert (>= (* 2 (* q q) (+ p 1)) limit)) (check-sat) (pop)

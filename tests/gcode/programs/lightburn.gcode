; LightBurn 1.4.00
; GRBL device profile, absolute coords
; Bounds: X10 Y10 to X50 Y30
G00 G17 G40 G21 G54
G90
M4
; Cut @ 1000 mm/min, 40% power
M8
G0 X10Y10
; Layer C00
G1 X50Y10S400F1000
G1 X50Y30
G1 X10Y30
G1 X10Y10
M9
G1 S0
M5
G90
; return to user-defined finish pos
G0 X0 Y0
M2

// Elementary functions in double precision from + - * /, sqrt and bit operations alone, so that every machine
// computes the same bits. The C library's are not used for anything that reaches a pixel: glibc chooses its
// variants by processor. Errors are relative, asserted in tests/engine/simd/portable_math_test.cpp.
#pragma once

namespace metamer::portable {

// e^x, 3e-16; 0 below -745.2, infinity above 709.8. Subnormal results are rounded once more.
double exp(double x);

// Natural logarithm, 3e-16; -infinity at 0, NaN below.
double log(double x);

// Sine, cosine and tangent of x in radians, 4e-16 (tan 8e-16) for |x| <= 1e6. For larger |x| the argument is
// first taken modulo the double nearest to 2 pi, absolute error |x| 1e-16. NaN for infinities.
double sin(double x);
double cos(double x);
double tan(double x);

// The angle of (x, y) in [-pi, pi], 5e-16; signed zeros as in C, but atan2(0, 0) and that of two infinities
// is 0, +-pi, or NaN respectively.
double atan2(double y, double x);

// Arc cosine, 6e-16 relative to the angle; NaN for |x| > 1.
double acos(double x);

// x^y, 4e-16 for a normal result. Negative x with integer y, and the values at 0, 1 and infinity, as IEEE 754.
double pow(double x, double y);

}  // namespace metamer::portable

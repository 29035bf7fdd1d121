#include "engine/simd/portable_math.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace metamer::portable {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double pi = 0x1.921fb54442d18p+1, pi_tail = 0x1.1a62633145c07p-53;

// ln 2 = high + low, high of 32 bits, so that its product with an exponent is exact.
constexpr double ln2_high = 0x1.62e42fee00000p-1, ln2_low = 0x1.a39ef35793c76p-33;

// Numbers carried as unevaluated sums high + low (T. Dekker, "A floating-point technique for extending the
// available precision", 1971). Used where 53 bits of an intermediate do not suffice.
struct Pair {
  double high, low;
};
Pair fast_sum(double a, double b) {  // |a| >= |b| or a = 0
  const double s = a + b;
  return {s, b - (s - a)};
}
Pair sum(double a, double b) {
  const double s = a + b, t = s - a;
  return {s, (a - (s - t)) + (b - t)};
}
Pair product(double a, double b) {
  constexpr double splitter = 0x1p27 + 1;
  const double ca = splitter * a, cb = splitter * b;
  const double ah = ca - (ca - a), al = a - ah;
  const double bh = cb - (cb - b), bl = b - bh;
  const double p = a * b;
  return {p, ((ah * bh - p) + ah * bl + al * bh) + al * bl};
}
Pair operator+(Pair a, Pair b) {
  const Pair s = sum(a.high, b.high);
  return fast_sum(s.high, s.low + (a.low + b.low));
}
Pair operator*(Pair a, Pair b) {
  const Pair p = product(a.high, b.high);
  return fast_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}

// x 2^n with |n| <= 2200, by steps that stay in range; rounds once more where the result is subnormal.
double scale(double x, int n) {
  const auto power = [](int e) { return std::bit_cast<double>(static_cast<uint64_t>(e + 1023) << 52); };
  while (n > 1023) x *= 0x1p1023, n -= 1023;
  while (n < -969) x *= 0x1p-969, n += 969;
  return x * power(n);
}

// x = m 2^e with m in [sqrt(1/2), sqrt(2)), for finite x > 0.
double split_exponent(double x, int* e) {
  int offset = 0;
  if (x < std::numeric_limits<double>::min()) x *= 0x1p54, offset = -54;
  const int64_t bits = std::bit_cast<int64_t>(x);
  const int64_t n = (bits - 0x3fe6a09e667f3bcd) >> 52;
  *e = static_cast<int>(n) + offset;
  return std::bit_cast<double>(bits - n * (int64_t{1} << 52));
}

// e^(high + low), |high| < 746, |low| tiny.
double exp_of(double high, double low) {
  const double n = std::floor(high * 0x1.71547652b82fep+0 + 0.5);
  const Pair r = fast_sum(high - n * ln2_high, low - n * ln2_low);
  // Taylor: the first neglected term is below 0.35^15 / 15! = 1e-19.
  double p = 0;
  for (double k = 14; k >= 2; k -= 1) p = (p + 1) * r.high / k;
  return scale(1 + (r.high + (r.high * p + r.low * (1 + r.high))), static_cast<int>(n));
}

// log(x) as a pair, for finite x > 0; relative error below 2^-63.
Pair log_pair(double x) {
  int e;
  const double m = split_exponent(x, &e);
  // log m = 2 atanh(s), s = (m - 1) / (m + 1), |s| <= 0.172, the first two terms in pairs.
  const double f = m - 1;
  const Pair g = sum(m, 1);
  const double s0 = f / g.high;
  const Pair back = product(s0, g.high);
  const Pair s = fast_sum(s0, ((f - back.high) - back.low - s0 * g.low) / g.high);
  const Pair s2 = s * s;
  double tail = 0;
  for (double k = 25; k >= 5; k -= 2) tail = tail * s2.high + 2 / k;
  const Pair cubic = s2 * s * (Pair{0x1.5555555555555p-1, 0x1.5555555555555p-55} + Pair{tail * s2.high, 0});
  const Pair log_m = Pair{2 * s.high, 2 * s.low} + cubic;
  return Pair{e * ln2_high, 0} + (Pair{e * ln2_low, 0} + log_m);
}

// x = n pi/2 + r, |r| <= pi/4 (a little more at the edges); returns n modulo 4.
int reduce_quadrant(double x, Pair* r) {
  // pi / 2 in pieces of 33, 33 and 53 bits: products with n < 2^20 are exact.
  constexpr double part_1 = 0x1.921fb54400000p+0, part_2 = 0x1.0b4611a600000p-34, part_3 = 0x1.3198a2e037073p-69;
  if (x > 1e6 || x < -1e6) x = std::fmod(x, 2 * pi);  // exact by definition
  const double n = std::floor(x * 0x1.45f306dc9c883p-1 + 0.5);
  const Pair near = sum(x - n * part_1, -(n * part_2));
  *r = fast_sum(near.high, near.low - n * part_3);
  return static_cast<int>(static_cast<int64_t>(n) & 3);
}

// Taylor series on |r| <= pi / 4: the first neglected terms are below 1e-19 of the result.
double sin_kernel(Pair r) {
  const double z = r.high * r.high;
  double p = 0;
  for (double k = 19; k >= 3; k -= 2) p = -(p + 1) * z / (k * (k - 1));
  return r.high + (r.high * p + r.low * (1 - 0.5 * z));
}
double cos_kernel(Pair r) {
  const double z = r.high * r.high;
  double p = 0;
  for (double k = 20; k >= 4; k -= 2) p = -(p + 1) * z / (k * (k - 1));
  // 1 - z/2 rounds; its error is carried along.
  const double half = 0.5 * z, one = 1 - half;
  return one + (((1 - one) - half) + (-half * p - r.high * r.low));
}

}  // namespace

double exp(double x) {
  if (x != x) return x;
  if (x > 709.8) return infinity;
  if (x < -745.2) return 0;
  return exp_of(x, 0);
}

double log(double x) {
  if (x != x || x == infinity) return x;
  if (x < 0) return nan;
  if (x == 0) return -infinity;
  const Pair p = log_pair(x);
  return p.high + p.low;
}

double sin(double x) {
  if (x - x != 0) return nan;
  if (x == 0) return x;
  Pair r;
  const int quadrant = reduce_quadrant(x, &r);
  const double value = (quadrant & 1) ? cos_kernel(r) : sin_kernel(r);
  return (quadrant & 2) ? -value : value;
}

double cos(double x) {
  if (x - x != 0) return nan;
  Pair r;
  const int quadrant = reduce_quadrant(x, &r);
  const double value = (quadrant & 1) ? sin_kernel(r) : cos_kernel(r);
  return (quadrant == 1 || quadrant == 2) ? -value : value;
}

double tan(double x) {
  if (x - x != 0) return nan;
  if (x == 0) return x;
  Pair r;
  const int quadrant = reduce_quadrant(x, &r);
  return (quadrant & 1) ? -cos_kernel(r) / sin_kernel(r) : sin_kernel(r) / cos_kernel(r);
}

double atan2(double y, double x) {
  if (x != x || y != y) return nan;
  const double ax = std::fabs(x), ay = std::fabs(y);
  if (ax == infinity && ay == infinity) return nan;
  const double large = std::fmax(ax, ay), small = std::fmin(ax, ay);
  double angle = 0;
  if (small > 0 && large < infinity) {
    // atan(q) = atan(k/8) + atan((q - k/8) / (1 + q k/8)), the remainder below 1/16.
    static constexpr double atan_eighths[9] = {0x0.0p+0,
                                               0x1.fd5ba9aac2f6ep-4,
                                               0x1.f5b75f92c80ddp-3,
                                               0x1.6f61941e4def1p-2,
                                               0x1.dac670561bb4fp-2,
                                               0x1.1e00babdefeb4p-1,
                                               0x1.4978fa3269ee1p-1,
                                               0x1.700a7c5784634p-1,
                                               0x1.921fb54442d18p-1};
    const double q = small / large;
    const double k = std::floor(q * 8 + 0.5);
    // Near 0 the quotient itself, so that nothing under- or overflows.
    double t = q;
    if (k > 0) {
      const double shrink = large > 1e300 ? 0x1p-10 : 1;
      const double a = small * shrink, b = large * shrink;
      t = (a - k / 8 * b) / (b + k / 8 * a);
    }
    const double z = t * t;
    double p = 0;
    for (double j = 17; j >= 3; j -= 2) p = (p * z + 1 / j) * -1;
    angle = atan_eighths[static_cast<int>(k)] + (t + t * z * p);
  }
  const bool left = std::signbit(x);
  if (ay > ax) {
    angle = pi / 2 + ((left ? angle : -angle) + pi_tail / 2);
  } else if (left) {
    angle = pi - (angle - pi_tail);
  }
  return std::copysign(angle, y);
}

double acos(double x) {
  if (!(x >= -1 && x <= 1)) return nan;
  return atan2(std::sqrt((1 - x) * (1 + x)), x);
}

double pow(double x, double y) {
  if (y == 0 || x == 1) return 1;
  if (x != x || y != y) return nan;
  const double ax = std::fabs(x);
  const bool whole = std::floor(y) == y;  // also infinities
  const bool odd = whole && std::fabs(y) < 0x1p53 && std::floor(y / 2) * 2 != y;
  if (std::fabs(y) == infinity) return ax == 1 ? 1 : ((ax > 1) == (y > 0) ? infinity : 0);
  const double sign = odd && std::signbit(x) ? -1 : 1;
  if (ax == 0) return y < 0 ? sign * infinity : sign * 0.0;
  if (ax == infinity) return y < 0 ? sign * 0.0 : sign * infinity;
  if (x < 0 && !whole) return nan;
  const Pair l = log_pair(ax);
  if (l.high * y > 709.8) return sign * infinity;
  if (l.high * y < -745.2) return sign * 0.0;
  const Pair power = l * Pair{y, 0};
  return sign * exp_of(power.high, power.low);
}

}  // namespace metamer::portable

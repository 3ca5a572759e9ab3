/* Laws of one's own for own_laws.py: compiled by cc -O2 -shared -fPIC own_laws.c -o own_laws.so -lm */
#include <math.h>
#include <stdint.h>

/* Drucker and Prager's law: q <= slope (p + tension). The snow of the example has E 1 MPa and a
   Poisson's ratio of 0.3, which gives its bulk modulus in 3D and in the plane. */
static const double slope = 1.0, tension = 500.0; /* -, Pa */
static const double bulk_3d = 1e6 / (3 * 0.4), bulk_2d = 1e6 / (2 * 1.3 * 0.4);

#define DRUCKER_PRAGER(NAME, T, BULK)                                                      \
  void NAME(int64_t count, T* p, T* q, T* plastic_strain, const uint8_t* snow, double dt) { \
    for (int64_t i = 0; i < count; ++i) {                                                  \
      const T pressure = p[i] < (T)-tension ? (T)-tension : p[i];                          \
      const T limit = (T)slope * (pressure + (T)tension);                                  \
      plastic_strain[i] += (pressure - p[i]) / (T)(BULK);                                  \
      p[i] = pressure;                                                                     \
      q[i] = q[i] < limit ? q[i] : limit;                                                  \
    }                                                                                      \
  }
DRUCKER_PRAGER(drucker_prager_2d, float, bulk_2d)
DRUCKER_PRAGER(drucker_prager_3d, float, bulk_3d)

/* The same as a constitutive law: from the elastic strain, as a tensor with SIZE components in D
   dimensions, to Kirchhoff's stress. With dt = 0 it only returns the stress. */
static const double mu = 1e6 / (2 * 1.3), lambda = 1e6 * 0.3 / (1.3 * 0.4);

#define DRUCKER_PRAGER_TENSOR(NAME, T, D, SIZE, BULK)                                             \
  void NAME(int64_t n, T* strain, T* stress, T* plastic_strain, T* own, const uint8_t* snow,      \
            double dt) {                                                                          \
    for (int64_t i = 0; i < n; ++i) {                                                             \
      T trace = 0, square = 0, deviator[SIZE];                                                    \
      for (int k = 0; k < D; ++k) trace += strain[k * n + i];                                     \
      for (int k = 0; k < SIZE; ++k) {                                                            \
        deviator[k] = strain[k * n + i] - (k < D ? trace / (T)D : 0);                             \
        square += (k < D ? 1 : 2) * deviator[k] * deviator[k];                                    \
      }                                                                                           \
      const T p_trial = (T)-(BULK) * trace, q = (T)mu * (T)sqrt(6 * square);                      \
      const T p = dt > 0 && p_trial < (T)-tension ? (T)-tension : p_trial;                        \
      const T limit = (T)slope * (p + (T)tension);                                                \
      const T ratio = dt > 0 && q > limit ? limit / q : 1;                                        \
      if (p != p_trial || ratio != 1) {                                                           \
        const T remaining = p != p_trial ? p / (T)-(BULK) : trace;                                \
        plastic_strain[i] += trace - remaining;                                                   \
        for (int k = 0; k < SIZE; ++k)                                                            \
          strain[k * n + i] = ratio * deviator[k] + (k < D ? remaining / (T)D : 0);               \
      }                                                                                           \
      for (int k = 0; k < SIZE; ++k)                                                              \
        stress[k * n + i] = 2 * (T)mu * ratio * deviator[k] - (k < D ? p : 0);                    \
    }                                                                                             \
  }
DRUCKER_PRAGER_TENSOR(drucker_prager_tensor_2d, float, 2, 3, bulk_2d)
DRUCKER_PRAGER_TENSOR(drucker_prager_tensor_3d, float, 3, 6, bulk_3d)

/* Brittle snow in the plane: elastic until the larger principal stress exceeds the strength. From
   then on the particle is cracked (own[i] = 1), and its principal stresses are not positive. */
static const double strength = 2000.0; /* Pa */

#define BRITTLE(NAME, T)                                                                          \
  void NAME(int64_t n, T* strain, T* stress, T* plastic_strain, T* own, const uint8_t* snow,      \
            double dt) {                                                                          \
    const T a = (T)(lambda + 2 * mu), b = (T)lambda;                                              \
    for (int64_t i = 0; i < n; ++i) {                                                             \
      const T half = (strain[i] - strain[n + i]) / 2, xz = strain[2 * n + i];                     \
      const T mean = (strain[i] + strain[n + i]) / 2, radius = (T)sqrt(half * half + xz * xz);    \
      const T cosine = radius > 0 ? half / radius : 1, sine = radius > 0 ? xz / radius : 0;       \
      T e1 = mean + radius, e2 = mean - radius;                                                   \
      if (dt > 0 && a * e1 + b * e2 > (own[i] > 0 ? 0 : (T)strength)) {                           \
        own[i] = 1;                                                                               \
        e1 = -b / a * e2;                                                                         \
        if (b * e1 + a * e2 > 0) e1 = e2 = 0;                                                     \
        plastic_strain[i] += 2 * mean - (e1 + e2);                                                \
        strain[i] = (e1 + e2) / 2 + (e1 - e2) / 2 * cosine;                                       \
        strain[n + i] = (e1 + e2) / 2 - (e1 - e2) / 2 * cosine;                                   \
        strain[2 * n + i] = (e1 - e2) / 2 * sine;                                                 \
      }                                                                                           \
      const T t1 = a * e1 + b * e2, t2 = b * e1 + a * e2;                                         \
      stress[i] = (t1 + t2) / 2 + (t1 - t2) / 2 * cosine;                                         \
      stress[n + i] = (t1 + t2) / 2 - (t1 - t2) / 2 * cosine;                                     \
      stress[2 * n + i] = (t1 - t2) / 2 * sine;                                                   \
    }                                                                                             \
  }
BRITTLE(brittle_2d, float)

/* Friction that falls with the sliding speed, as of snow on a film of melt water. */
double melting(double speed, double normal_stress) { return 0.1 + 0.4 * exp(-speed / 0.5); }

/* Wind along x, which grows with the height. */
void wind(int64_t count, const double* x, const double* y, const double* z, double time, double* ax,
          double* ay, double* az) {
  for (int64_t i = 0; i < count; ++i) ax[i] = z[i] > 0 ? 0.5 * z[i] : 0;
}

/* A plate that shakes along x, 5 mm at 4 Hz. */
void shaking(double time, double* pose) {
  const double rate = 2 * 3.14159265358979 * 4;
  pose[0] = 0.005 * sin(rate * time);        /* translation along x, m */
  pose[6] = 0.005 * rate * cos(rate * time); /* velocity along x, m/s */
}

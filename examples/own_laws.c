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

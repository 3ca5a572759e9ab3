// Conjugate gradients whose result does not depend on the number of threads.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "snowshed/core/aligned_vector.hpp"
#include "snowshed/core/parallel.hpp"

namespace snowshed::methods::mps {

struct SolveReport {
  int iterations = 0;
  double residual = 0;  // norm of the residual over the norm that the tolerance refers to
  bool converged = true;
};

struct CgWorkspace {
  AlignedVector<double> r, z, p, q;
  std::vector<double> sums;
};

namespace conjugate_gradient_details {

inline constexpr std::ptrdiff_t piece = 512;

/// The sum of f(i) in a fixed order.
template <class F>
double sum_of(std::size_t n, int threads, std::vector<double>& sums, F f) {
  sums.resize((n + std::size_t(piece) - 1) / std::size_t(piece));
  parallel_pieces(std::ptrdiff_t(n), threads, piece, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    double sum = 0;
    for (std::ptrdiff_t i = begin; i < end; ++i) sum += f(std::size_t(i));
    sums[std::size_t(begin / piece)] = sum;
  });
  double total = 0;
  for (const double sum : sums) total += sum;
  return total;
}

template <class F>
void for_each(std::size_t n, int threads, F f) {
  parallel_pieces(std::ptrdiff_t(n), threads, piece, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) f(std::size_t(i));
  });
}

}  // namespace conjugate_gradient_details

/// Solves A x = b with a symmetric positive definite A from the given x, until the norm of the
/// residual is at most `tolerance` times `scale`. apply(p, q) computes q = A p, and precondition(r,
/// z) an approximate z = A^-1 r.
template <class Apply, class Precondition>
SolveReport conjugate_gradients(std::size_t n, double tolerance, double scale, int max_iterations,
                                int threads, CgWorkspace& work, double* x, const double* b,
                                const Apply& apply, const Precondition& precondition) {
  namespace cg = conjugate_gradient_details;
  for (auto* vector : {&work.r, &work.z, &work.p, &work.q}) vector->resize(n);
  double *r = work.r.data(), *z = work.z.data(), *p = work.p.data(), *q = work.q.data();
  SolveReport report;
  apply(x, q);
  double r2 = cg::sum_of(n, threads, work.sums, [&](std::size_t i) {
    r[i] = b[i] - q[i];
    return r[i] * r[i];
  });
  const double limit = tolerance * scale;
  double rz = 0;
  while (std::sqrt(r2) > limit && report.iterations < max_iterations) {
    precondition(r, z);
    const double next =
        cg::sum_of(n, threads, work.sums, [&](std::size_t i) { return r[i] * z[i]; });
    const double beta = report.iterations > 0 ? next / rz : 0.0;
    rz = next;
    if (report.iterations == 0)
      cg::for_each(n, threads, [&](std::size_t i) { p[i] = z[i]; });
    else
      cg::for_each(n, threads, [&](std::size_t i) { p[i] = z[i] + beta * p[i]; });
    apply(p, q);
    const double pq = cg::sum_of(n, threads, work.sums, [&](std::size_t i) { return p[i] * q[i]; });
    if (!(pq > 0)) break;
    const double alpha = rz / pq;
    r2 = cg::sum_of(n, threads, work.sums, [&](std::size_t i) {
      x[i] += alpha * p[i];
      r[i] -= alpha * q[i];
      return r[i] * r[i];
    });
    ++report.iterations;
  }
  report.converged = std::sqrt(r2) <= limit;
  report.residual = scale > 0 ? std::sqrt(r2) / scale : 0.0;
  return report;
}

}  // namespace snowshed::methods::mps

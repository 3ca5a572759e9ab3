"""The slab of cpp/bench/solver_bench.cpp, side by side in snowshed and in Taichi.

Usage: python -m benchmarks.taichi_slab [--steps 50] [--threads 2] [--atomic] [--json FILE]

The benchmark needs Taichi (pip install taichi). The slab has 262 144 particles of reference snow on
sticky ground, with float, quadratic splines and FLIP 0.99. Taichi gets snowshed's time
steps for free. The final states are compared. Numbers in parentheses are equations of
docs/methods/mpm.md.

The Taichi version is the fastest of several variants: grid flat or in blocks, as one or eight
arrays; particles as one or many arrays; stress in a separate kernel or not; transfers fused or not.
Particles are sorted by cell once. Slabs of cells scatter in two colours without atomic operations.
This is correct until a particle is two cells away from its slab. --atomic scatters with atomic
operations, as is usual in Taichi.
"""

import argparse
import json
import math
import time
from pathlib import Path
from statistics import median

import numpy as np

from snowshed import Scene, _core
from snowshed.base.machine import cpu_name

try:
    import taichi as ti
except ImportError:
    raise SystemExit("error: this benchmark needs Taichi (pip install taichi)") from None

DX = 1 / 32  # m
CELLS = (64, 16, 32)
MARGIN = 8  # empty cells around the slab
WIDTH = 8  # cells along x whose particles one thread scatters
WARM_UP = 10  # untimed steps
REPETITIONS = 3  # runs
TOLERANCE = 0.02  # relative difference of mean fall and of mean bottom pressure
CASES = {"at rest": [0.0, 0.0, 0.0], "falling": [0.0, 0.0, -5.0]}  # initial velocity, m/s
ORDERS = range(8, 0, -1)  # orders of the power series, from the highest
LOG1P = (*((-1) ** (k + 1) / k for k in ORDERS), 0.0)
EXPM1 = (*(1 / math.factorial(k) for k in ORDERS), 0.0)


@ti.func
def power_series(coefficients: ti.template(), a):
    """Return the sum of c_k a^k by Horner's scheme and Cayley-Hamilton."""
    a2 = a @ a
    i1, i3 = a.trace(), a.determinant()
    i2 = 0.5 * (i1 * i1 - a2.trace())
    s0, s1, s2 = 0.0, 0.0, 0.0
    for c in ti.static(coefficients):
        s0, s1, s2 = c + i3 * s2, s0 - i2 * s2, s1 + i1 * s2
    return s0 * ti.Matrix.identity(ti.f32, 3) + s1 * a + s2 * a2


@ti.data_oriented
class CamClay:
    """Snow with elasticity (1)-(5), yield surface (6), hardening (7), return mapping (9)-(11)."""

    def __init__(self, snow):
        e, nu = snow["youngs_modulus"], snow["poissons_ratio"]
        self.mu, self.bulk = e / (2 * (1 + nu)), e / (3 - 6 * nu)
        self.root6_mu = math.sqrt(6) * self.mu
        self.beta, self.xi = snow["cohesion"], snow["hardening_factor"]
        self.shear = (1 + 2 * self.beta) / snow["critical_state_slope"] ** 2
        self.ev0 = -math.asinh(snow["preconsolidation_pressure"] / self.bulk) / self.xi

    @ti.func
    def preconsolidation(self, ev):
        """Return p0 (7) and its slope; the power series of sinh is exact enough, also near zero."""
        x = self.xi * ti.max(-ev, 0.0)
        slope = -self.bulk * self.xi * (1 + x * x / 2 * (1 + x * x / 12))
        return self.bulk * x * (1 + x * x / 6 * (1 + x * x / 20)), ti.select(ev < 0, slope, 0.0)

    @ti.func
    def plastic_change(self, p_trial, q_trial, ev):
        """Return the root D of (10) by Newton's steps, or bisection if they leave the bracket."""
        p0, p0_slope = self.preconsolidation(ev)
        side = 2 * p_trial - (1 - self.beta) * p0
        c = 6 * self.mu * self.shear
        d, near, far = 0.0, 0.0, ti.select(side > 0, -p_trial / self.bulk, ti.max(-ev, 0.0))
        for _ in range(60):
            p0, p0_slope = self.preconsolidation(ev + d)
            p = p_trial + self.bulk * d
            n, n_slope = 2 * p - (1 - self.beta) * p0, 2 * self.bulk - (1 - self.beta) * p0_slope
            flow = n - c * d + 1e-30
            q, q_slope = q_trial * n / flow, q_trial * c * (n - d * n_slope) / (flow * flow)
            left, right = p + self.beta * p0, p - p0
            y = self.shear * q * q + left * right
            y_slope = 2 * self.shear * q * q_slope + left * (self.bulk - p0_slope)
            y_slope += right * (self.bulk + self.beta * p0_slope)
            rounding = 3e-7 * (self.shear * q * q + (abs(p) + self.beta * p0) * (abs(p) + p0))
            before_centre = n * side > 0
            if before_centre and abs(y) <= rounding:
                break
            if before_centre and y > 0:
                near = d
            else:
                far = d
            d -= y / y_slope
            if not (before_centre and (d - near) * (d - far) < 0):
                d = 0.5 * (near + far)
        return d

    @ti.func
    def return_map(self, p_trial, q_trial, ev):
        """Return pressure, Mises stress and volumetric plastic strain within the yield surface."""
        p, q = p_trial, q_trial
        p0, _ = self.preconsolidation(ev)
        if self.shear * q * q + (p + self.beta * p0) * (p - p0) > 0:
            ev_origin = ev - p / self.bulk
            p0_origin, _ = self.preconsolidation(ev_origin)
            if ti.select(2 * p > (1 - self.beta) * p0, p0_origin <= 0, ev_origin >= 0):
                p, q = 0.0, 0.0
            else:
                d = self.plastic_change(p, q, ev)
                p0, _ = self.preconsolidation(ev + d)
                p = ti.min(ti.max(p + self.bulk * d, -self.beta * p0), p0)
                q = ti.min(q, ti.sqrt((p + self.beta * p0) * (p0 - p) / self.shear))
        return p, q, ev + (p - p_trial) / self.bulk

    @ti.func
    def stress(self, b, ev):
        """Return Kirchhoff stress, elastic b - I and plastic strain from the trial b - I."""
        identity = ti.Matrix.identity(ti.f32, 3)
        strain = 0.5 * power_series(LOG1P, b)
        shear = strain - strain.trace() / 3 * identity
        q_trial = self.root6_mu * shear.norm()
        p, q, ev_new = self.return_map(-self.bulk * strain.trace(), q_trial, ev)
        b_new = b
        if q != q_trial or ev_new != ev:
            shear *= q / ti.max(q_trial, 1e-30)
            b_new = power_series(EXPM1, 2 * (shear - p / (3 * self.bulk) * identity))
        return 2 * self.mu * shear - p * identity, b_new, ev_new


@ti.data_oriented
class TaichiSlab:
    """Slab of a snowshed scene in Taichi; lengths are in cells, all other values in SI units."""

    def __init__(self, scene, positions, mass, atomic):
        self.clay, self.gravity = CamClay(scene["snow"]), scene["gravity"]
        self.flip, self.atomic = scene["numerics"]["flip_ratio"], atomic
        self.mass, self.volume, self.count = mass, mass / scene["snow"]["density"], len(positions)
        cells = np.floor(positions / DX).astype(int)
        self.order = np.lexsort(cells.T[::-1])
        self.start = (positions[self.order] / DX + MARGIN).astype(np.float32)
        self.slabs = CELLS[0] // WIDTH
        self.ends = ti.field(ti.i32, self.slabs + 1)
        ends = np.searchsorted(cells[self.order, 0], range(0, CELLS[0] + 1, WIDTH))
        self.ends.from_numpy(ends.astype(np.int32))
        self.x, self.v = ti.Vector.field(3, ti.f32), ti.Vector.field(3, ti.f32)
        self.b, self.tau = ti.Matrix.field(3, 3, ti.f32), ti.Matrix.field(3, 3, ti.f32)
        self.ev = ti.field(ti.f32)
        ti.root.dense(ti.i, self.count).place(self.x, self.v, self.b, self.tau, self.ev)
        # Mass, momentum and force; after the update mass, velocity and change of velocity.
        self.grid = ti.Vector.field(8, ti.f32, shape=tuple(n + 2 * MARGIN for n in CELLS))

    def reset(self, velocity):
        """Reset the slab to the unstressed lattice."""
        self.x.from_numpy(self.start)
        self.v.fill(ti.Vector(velocity))
        self.b.fill(0.0)
        self.tau.fill(0.0)
        self.ev.fill(self.clay.ev0)

    @ti.func
    def splines(self, x):
        """Return the first of three nodes along each axis, splines (19) and their slopes."""
        base = ti.cast(x - 0.5, ti.i32)
        f = x - base
        weights = [0.5 * (1.5 - f) ** 2, 0.75 - (f - 1) ** 2, 0.5 * (f - 0.5) ** 2]
        return base, weights, [f - 1.5, 2 - 2 * f, f - 0.5]

    @ti.kernel
    def particles_to_grid(self, first: ti.i32, stride: ti.i32):
        """Scatter (13) from all slabs, or from the slabs of a colour, which share no nodes."""
        ti.loop_config(block_dim=1)
        for n in range(self.slabs // stride):
            slab = first + n * stride
            for p in range(self.ends[slab], self.ends[slab + 1]):
                base, w, g = self.splines(self.x[p])
                stress, momentum = self.tau[p] * (-self.volume / DX), self.mass * self.v[p]
                for i, j, k in ti.static(ti.ndrange(3, 3, 3)):
                    wx, wy, wz = w[i][0], w[j][1], w[k][2]
                    weight, slope_x, slope_y = wx * wy * wz, g[i][0] * wy * wz, wx * g[j][1] * wz
                    gradient = ti.Vector([slope_x, slope_y, wx * wy * g[k][2]])
                    m, f = momentum * weight, stress @ gradient
                    sums = ti.Vector([self.mass * weight, m.x, m.y, m.z, f.x, f.y, f.z, 0.0])
                    node = base + ti.Vector([i, j, k])
                    if ti.static(self.atomic):
                        self.grid[node] += sums
                    else:  # Taichi makes += atomic, but not this sum.
                        self.grid[node] = self.grid[node] + sums

    @ti.kernel
    def update_grid(self, dt: ti.f32):
        """Apply (14) and the sticky ground."""
        for node in ti.grouped(self.grid):
            s = self.grid[node]
            if s[0] > 0:
                old = ti.Vector([s[1], s[2], s[3]]) / s[0]
                new = old + dt * ti.Vector([s[4], s[5], s[6]]) / s[0]
                new.z -= dt * self.gravity
                new *= ti.cast(node.z > MARGIN, ti.f32)
                d = new - old
                self.grid[node] = ti.Vector([s[0], new.x, new.y, new.z, d.x, d.y, d.z, 0.0])

    @ti.kernel
    def grid_to_particles(self, dt: ti.f32):
        """Apply (15) to (17), and update the stress."""
        for p in self.x:
            base, w, g = self.splines(self.x[p])
            velocity, change = ti.Vector.zero(ti.f32, 3), ti.Vector.zero(ti.f32, 3)
            move = ti.Matrix.zero(ti.f32, 3, 3)
            for i, j, k in ti.static(ti.ndrange(3, 3, 3)):
                wx, wy, wz = w[i][0], w[j][1], w[k][2]
                weight, slope_x, slope_y = wx * wy * wz, g[i][0] * wy * wz, wx * g[j][1] * wz
                gradient = ti.Vector([slope_x, slope_y, wx * wy * g[k][2]])
                s = self.grid[base + ti.Vector([i, j, k])]
                v = ti.Vector([s[1], s[2], s[3]])
                velocity += weight * v
                change += weight * ti.Vector([s[4], s[5], s[6]])
                move += v.outer_product(gradient) * (dt / DX)
            self.x[p] += velocity * (dt / DX)
            self.v[p] = self.flip * (self.v[p] + change) + (1 - self.flip) * velocity
            b = self.b[p] + move @ self.b[p]
            trial = b + b @ move.transpose() + move + move.transpose() + move @ move.transpose()
            self.tau[p], self.b[p], self.ev[p] = self.clay.stress(trial, self.ev[p])

    def run(self, time_steps):
        """Take steps of the given lengths, s."""
        for dt in time_steps:
            self.grid.fill(0.0)
            for colour in range(1 if self.atomic else 2):
                self.particles_to_grid(colour, 1 if self.atomic else 2)
            self.update_grid(dt)
            self.grid_to_particles(dt)
        ti.sync()

    def state(self):
        """Return heights (m) and pressures (Pa) in the order of the initial positions."""
        heights, pressures = np.empty(self.count), np.empty(self.count)
        heights[self.order] = (self.x.to_numpy()[:, 2] - MARGIN) * DX
        pressures[self.order] = -self.tau.to_numpy().trace(axis1=1, axis2=2) / 3
        return heights, pressures


def snowshed_slab(velocity, threads):
    """Return snowshed's simulation of the slab without sleep."""
    size = [n * DX for n in CELLS]
    box = {"type": "box", "center": [s / 2 for s in size], "size": size}
    numerics = {"transfer": "flip", "flip_ratio": 0.99, "basis": "quadratic", "sleep_speed": 0}
    scene = Scene.from_data(
        {
            "dimension": 3,
            "snow": json.loads(_core.snow_preset("reference")),
            "ground": {"condition": "sticky"},
            "bodies": [{"shape": box, "velocity": velocity}],
            "seeding": {"pattern": "regular", "particles_per_voxel": 8},
            "numerics": {"dx": DX, "precision": "float", "threads": threads, **numerics},
        }
    )
    simulation = _core.Simulation(scene.resolve().json)
    simulation.begin_event()
    return simulation


def time_snowshed(velocity, threads, steps):
    """Return the wall time of the steps after the warm-up, s."""
    simulation = snowshed_slab(velocity, threads)
    simulation.step(WARM_UP)
    start = time.perf_counter()
    simulation.step(steps)
    return time.perf_counter() - start


def time_taichi(slab, velocity, time_steps):
    """Return the wall time of the steps after the warm-up, s."""
    slab.reset(velocity)
    slab.run(time_steps[:WARM_UP])
    start = time.perf_counter()
    slab.run(time_steps[WARM_UP:])
    return time.perf_counter() - start


def measure(velocity, args):
    """Time both programs in turn, and compare the final mean height and bottom pressure."""
    simulation = snowshed_slab(velocity, args.threads)
    start = simulation.positions()
    mass = float(simulation.masses()[0])
    slab = TaichiSlab(json.loads(simulation.scene), start, mass, args.atomic)
    times = [simulation.time_s]
    for _ in range(WARM_UP + args.steps):
        simulation.step()
        times.append(simulation.time_s)
    slab.reset(velocity)
    slab.run([0.0])  # compile the kernels
    walls = [
        (
            time_snowshed(velocity, args.threads, args.steps),
            time_taichi(slab, velocity, np.diff(times)),
        )
        for _ in range(REPETITIONS)
    ]
    speeds = [len(start) * args.steps / median(wall) / 1e6 for wall in zip(*walls)]
    bottom = start[:, 2] < DX
    states = (simulation.positions()[:, 2], simulation.pressures()), slab.state()
    falls, pressures = zip(*((np.mean(start[:, 2] - z), np.mean(p[bottom])) for z, p in states))
    return {
        "m_updates_per_s": speeds,
        "ratio": speeds[0] / speeds[1],
        "mean_fall_m": falls,
        "bottom_pressure_pa": pressures,
        "difference": max(abs(b / a - 1) for a, b in (falls, pressures)),
    }


def main():
    """Measure and print the results; fail if the two programs do not agree."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--steps", type=int, default=50, help="steps timed in each run")
    parser.add_argument("--threads", type=int, default=2, choices=range(1, 5))
    parser.add_argument("--atomic", action="store_true", help="scatter with atomics in Taichi")
    parser.add_argument("--json", type=Path, help="file for the results")
    args = parser.parse_args()
    ti.init(arch=ti.cpu, cpu_max_num_threads=args.threads, log_level=ti.WARN)
    cases = {}
    for name, velocity in CASES.items():
        case = cases[name] = measure(velocity, args)
        print(f"{name}, {args.threads} threads: snowshed, Taichi")
        print("  million updates/s   {:.2f}, {:.2f}".format(*case["m_updates_per_s"]), end="")
        print(f", ratio {case['ratio']:.2f}")
        print("  mean fall, m        {:.4g}, {:.4g}".format(*case["mean_fall_m"]))
        print("  bottom pressure, Pa {:.4g}, {:.4g}".format(*case["bottom_pressure_pa"]))
        print(f"  greatest difference {case['difference']:.2%}, allowed {TOLERANCE:.0%}")
    record = {"cpu": cpu_name(), "threads": args.threads, "steps": args.steps, "cases": cases}
    if args.json:
        args.json.write_text(json.dumps(record, indent=2) + "\n", encoding="utf-8")
    if not all(case["difference"] <= TOLERANCE for case in cases.values()):
        raise SystemExit("error: the two do not compute the same; their speeds mean nothing")


if __name__ == "__main__":
    main()

import numpy as np
import pandas as pd
import pytest
from helpers.piles import ball, cone, triangle

from snowshed import InputError, SnowshedNote, measure_stack
from snowshed.snow import levelled_positions
from snowshed.snow.stack.trimming import TRIMMINGS


def measure(positions, *, dimension=2, density=200.0, mass=0.001, dx=0.02, **options):
    ones = np.ones(len(positions))
    return measure_stack(
        positions, mass * ones, density * ones, dimension=dimension, dx=dx, **options
    )


def tilt(positions, degrees):
    """Lay level snow on ground that falls in +x."""
    psi = np.radians(degrees)
    down, up = np.array([np.cos(psi), 0, -np.sin(psi)]), np.array([np.sin(psi), 0, np.cos(psi)])
    x, y, z = positions.T
    return np.outer(x, down) + np.outer(y, [0, 1, 0]) + np.outer(z, up)


def test_the_measure_of_a_ridge():
    """A triangle loses 1.5 % at either end, sqrt(0.03) of half its base, and a surface cell."""
    base, height = 1.0, 0.3
    stack = measure(triangle(base, height))
    length = base * (1 - np.sqrt(0.03))
    assert stack.height == pytest.approx(height, rel=0.03)
    assert length - 2 * length / 30 <= stack.length <= length + 0.002
    assert stack.tail - stack.head == pytest.approx(stack.length)
    assert stack.head == pytest.approx(-stack.tail, abs=length / 30)
    assert stack.crest == pytest.approx(0.0, abs=0.03)
    assert stack.width == 1.0


def test_the_measure_of_a_cone():
    """97 % of a cone's volume lies within 0.894 of its radius: 3 s^2 - 2 s^3 = 0.97."""
    stack = measure(cone(0.5, 0.3), dimension=3)
    assert stack.height == pytest.approx(0.3, rel=0.05)
    assert stack.length == pytest.approx(2 * 0.894 * 0.5, abs=0.035)
    assert stack.width == pytest.approx(stack.length, abs=0.03)
    assert stack.crest == pytest.approx(0.0, abs=0.03)


@pytest.mark.parametrize("psi", [0.0, 12.0])
def test_centre_of_mass_and_spread_of_a_triangle(psi):
    """A triangle's centre is at a third of its height; its spread is base / sqrt(24)."""
    stack = measure(tilt(triangle(1.0, 0.3, count=40_000), psi), ground_tilt_deg=psi)
    assert stack.centre_height == pytest.approx(0.1, rel=0.01)
    assert stack.spread == pytest.approx(1 / np.sqrt(24), rel=0.01)


def test_centre_of_mass_and_spread_count_masses():
    x, masses = np.array([[0.0, 0, 0.1], [2.0, 0, 0.5]]), np.array([3.0, 1.0])
    stack = measure_stack(x, masses, np.full(2, 200.0), dimension=2, dx=5.0)
    assert stack.centre_height == pytest.approx(0.2)
    assert stack.spread == pytest.approx(2 * np.sqrt(3) / 4)


@pytest.mark.parametrize("gap, bodies", [(0.005, 1), (0.025, 2)])
def test_bodies_do_not_depend_on_the_grid(gap, bodies):
    x, z = np.meshgrid(np.arange(0, 0.1, 0.001), np.arange(0, 0.02, 0.001))
    slab = np.column_stack([x.ravel(), 0 * x.ravel(), z.ravel()])
    both = np.vstack([slab, slab + [x.max() + gap, 0, 0]])
    for dx in (0.01, 0.005, 0.0025):
        stack = measure(both, dx=dx)
        assert stack.detached_mass == pytest.approx((bodies - 1) * stack.mass / bodies)


def test_mass_volume_and_density():
    pile = triangle(1.0, 0.3, count=1000)
    densities = np.where(np.arange(1000) < 500, 100.0, 300.0)
    stack = measure_stack(pile, np.full(1000, 0.3), densities, dimension=2, dx=0.1)
    assert stack.mass == pytest.approx(300)
    assert stack.volume == pytest.approx(2.0)
    assert stack.density == pytest.approx(150)


def test_a_dispersed_particle_fills_at_most_a_voxel():
    pile = triangle(1.0, 0.3, count=1000)
    densities = np.full(1000, 200.0)
    densities[:10], densities[10:20] = 1e-70, 0.0
    stack = measure_stack(pile, np.full(1000, 0.3), densities, dimension=2, dx=0.1)
    assert stack.volume == pytest.approx(980 * 0.0015 + 20 * 0.01)


def test_a_roller_counts_for_the_stack_but_not_for_its_body():
    ridge, roller = triangle(1.0, 0.3), ball((4.0, 0, 0.05), 0.05, 3000)
    alone, together = measure(ridge), measure(np.vstack([ridge, roller]))
    assert together.length > 4
    assert together.body.length == pytest.approx(alone.length, abs=0.01)
    assert together.body.height == pytest.approx(alone.height)
    assert together.detached_mass == pytest.approx(3.0)
    assert together.mass == pytest.approx(43.0)


def test_a_stack_has_both_readings_and_reports_the_requested_one():
    snow = np.vstack([triangle(1.0, 0.3), ball((4.0, 0, 0.05), 0.05, 1000)])
    stacks = {name: measure(snow, trimming=name) for name in TRIMMINGS}
    for name, stack in stacks.items():
        assert stack.trimming == name
        assert (stack.length, stack.head) == (stack.trimmed[name].length, stack.trimmed[name].head)
        assert stack.trimmed["outermost_first"].length < 1 < 4 < stack.trimmed["equal_pace"].length
    solid = measure(cone(0.5, 0.3), dimension=3, trimming="equal_pace")
    assert repr(solid.trimmed["equal_pace"]) == repr(solid.trimmed["outermost_first"])


def test_snow_on_the_panel_is_excluded():
    ridge, slab = triangle(1.0, 0.3), ball((-1.0, 0, 1.0), 0.1, 500)
    together = np.vstack([ridge, slab])
    on_panel = np.arange(len(together)) >= len(ridge)
    stack, alone = measure(together, exclude=on_panel), measure(ridge)
    assert stack.on_panel_mass == pytest.approx(0.5)
    assert (stack.height, stack.length, stack.mass) == (alone.height, alone.length, alone.mass)


@pytest.mark.parametrize("degrees", [-20, 5, 30])
def test_tilted_ground_does_not_change_the_measure(degrees):
    pile = triangle(1.0, 0.3, count=5000) + [0.7, 0, 0]
    flat = measure(pile)
    sloped = measure(tilt(pile, degrees), ground_tilt_deg=degrees)
    for name in ("height", "length", "head", "tail", "crest", "mass", "detached_mass"):
        assert getattr(sloped, name) == pytest.approx(getattr(flat, name), abs=1e-9), name
    assert np.allclose(sloped.outline, flat.outline)


def test_level_turns_the_ground_normal_upright():
    psi = np.radians(25)
    normal = np.array([[np.sin(psi), 0, np.cos(psi)]])
    assert np.allclose(levelled_positions(normal, 25), [[0, 0, 1]])
    points = np.random.default_rng(1).normal(size=(10, 3))
    assert np.allclose(levelled_positions(levelled_positions(points, 25), -25), points)


@pytest.mark.parametrize("dimension", [2, 3])
def test_without_snow_a_stack_is_empty(dimension):
    stack = measure(np.zeros((0, 3)), dimension=dimension)
    assert (stack.height, stack.length, stack.mass, stack.body.height) == (0, 0, 0, 0)
    assert np.isnan(stack.head) and np.isnan(stack.density)
    assert stack.outline.shape == (0, 2)


def test_all_snow_on_the_panel_gives_an_empty_stack():
    stack = measure(triangle(1.0, 0.3, count=100), exclude=np.ones(100, dtype=bool))
    assert stack.mass == 0
    assert stack.on_panel_mass == pytest.approx(0.1)


def test_input_is_not_changed():
    pile = triangle(1.0, 0.3, count=100)
    before = pile.copy()
    measure(pile)
    assert np.array_equal(pile, before)


def test_arrays_lists_and_tables_give_the_same_stack():
    pile = triangle(1.0, 0.3, count=300).astype(np.float32)
    table = pd.DataFrame({"x": pile[:, 0], "z": pile[:, 2], "mass": 0.25, "density": 200})
    exclude = [i < 5 for i in range(300)]
    options = {"dimension": 2, "dx": 0.1, "exclude": exclude, "ground_tilt_deg": 10}
    expected = measure_stack(pile, np.full(300, 0.25), np.full(300, 200.0), **options)
    from_lists = measure_stack(pile.tolist(), [0.25] * 300, [200] * 300, **options)
    from_table = measure_stack(table[["x", "z"]], table["mass"], table["density"], **options)
    for stack in (from_lists, from_table):
        assert repr(stack) == repr(expected)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"positions": np.zeros(3)}, r"positions: an array of shape \(3,\); needed: \(n, 3\)"),
        ({"positions": np.zeros((4, 2))}, r"positions: .* needed: \(n, 3\) in 3D"),
        ({"positions": [[0, 0, 0], [1]]}, "positions: not an array of numbers"),
        ({"positions": np.full((2, 3), np.nan)}, r"positions: nan at index \(0, 0\)"),
        ({"positions": np.array([["a"] * 3] * 2)}, "positions: not an array of numbers"),
        ({"masses": [1.0]}, r"masses: an array of shape \(1,\); needed: \(2,\)"),
        ({"masses": [1.0, -2.0]}, "masses: -2 at index 1; no number may be negative"),
        ({"masses": [1.0, np.inf]}, "masses: inf at index 1; all must be finite"),
        ({"densities": [[1.0, 1.0]]}, r"densities: an array of shape \(1, 2\)"),
        ({"densities": [-1.0, 1.0]}, "densities: -1 at index 0"),
        ({"exclude": [True]}, r"exclude: an array of shape \(1,\); needed: \(2,\)"),
        ({"exclude": [0, 1]}, "exclude: values of type int64; only booleans"),
        ({"dimension": 4}, "dimension: 4; allowed: 2, 3"),
        ({"dx": 0.0}, "dx: 0; it must be above 0"),
        ({"dx": "small"}, "dx: 'small'; needed: a number"),
        ({"ground_tilt_deg": np.nan}, "ground_tilt_deg: nan; a finite number"),
        ({"trimming": "3D"}, "trimming: '3D' is unknown; allowed: outermost_first, equal_pace"),
    ],
)
def test_errors_name_the_argument(given, message):
    valid = {
        "positions": np.zeros((2, 3)),
        "masses": np.ones(2),
        "densities": np.ones(2),
        "dimension": 3,
        "dx": 0.1,
    }
    with pytest.raises(InputError, match=message):
        measure_stack(**{**valid, **given})


def test_a_measured_stack_prints_on_one_line():
    heap = np.random.default_rng(1).uniform(0, 0.1, (500, 3))
    measured = measure_stack(heap, np.ones(500), np.full(500, 210.0), dimension=3, dx=0.02)
    assert "\n" not in repr(measured)
    assert f"height {measured.height:.4g} m" in repr(measured)


def test_positions_in_millimetres_are_told():
    with pytest.warns(SnowshedNote, match=r"the particles span .* are the positions in mm"):
        measure(1000.0 * triangle(1.0, 0.3))


def test_positions_in_centimetres_are_told():
    x, z = np.meshgrid(np.linspace(0, 1, 101), np.linspace(0, 0.2, 21))
    heap = np.column_stack([x.ravel(), 0 * x.ravel(), z.ravel()])
    message = r"most of the mass is detached, .*; check the unit"
    with pytest.warns(SnowshedNote, match=message) as notes:
        measured = measure(100.0 * heap, mass=0.02, dx=0.01)
    assert len(notes) == 1
    assert measured.detached_mass > 0.5 * measured.mass


def test_two_separate_stacks_and_a_few_particles_have_no_notes(recwarn):
    heaps = [triangle(1.0, 0.3) + [5.0 * k, 0.0, 0.0] for k in range(3)]
    assert measure(np.concatenate(heaps)).detached_mass > 0.0
    measure(np.array([[0.1 * k, 0.0, 0.0] for k in range(5)]))
    assert [str(note.message) for note in recwarn] == []


@pytest.mark.parametrize("density", [0.2, 2e5])
def test_densities_in_other_units_are_told(density):
    with pytest.warns(SnowshedNote, match=r"densities: half of them are .* are they in g/cm3"):
        measure(triangle(1.0, 0.3), density=density)


def test_usual_stacks_have_no_notes(recwarn):
    measure(triangle(1.0, 0.3))
    measure(cone(1.0, 0.3), dimension=3)
    assert [str(note.message) for note in recwarn] == []


def test_a_table_of_positions_is_read_by_name():
    snow = triangle(1.0, 0.3)
    table = pd.DataFrame(snow[:, ::-1], columns=["z", "y", "x"])
    assert measure(table).length == measure(snow).length
    assert measure(table.add_prefix("position_")).length == measure(snow).length
    with pytest.raises(InputError, match="columns a, b, c; needed: the columns x, y and z"):
        measure(table.set_axis(["a", "b", "c"], axis=1))

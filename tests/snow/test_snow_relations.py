"""Published relations against values that can be checked by hand, and their ranges."""

import math

import pytest

from snowshed import InputError, Snow
from snowshed.snow import NEW_SNOW_DENSITY, TENSILE_STRENGTH, YOUNGS_MODULUS, snow_from_density

RELATIONS = [*NEW_SNOW_DENSITY.values(), *YOUNGS_MODULUS.values(), *TENSILE_STRENGTH.values()]


def test_densities_at_the_melting_point():
    assert NEW_SNOW_DENSITY["hedstrom-pomeroy-1998"](0.0) == pytest.approx(119.17)
    assert NEW_SNOW_DENSITY["vionnet-2012"](0.0, 4.0) == pytest.approx(161.0)
    still = 500.0 * (1.0 - 0.951 * math.exp(-1.4 * 5.0**-1.15))
    assert NEW_SNOW_DENSITY["jordan-1999"](0.0, 0.0) == pytest.approx(still)


def test_at_the_density_of_ice_the_power_laws_give_their_factors():
    assert YOUNGS_MODULUS["bergfeld-2023"](917.0) == pytest.approx(6.5e9)
    assert TENSILE_STRENGTH["sigrist-2006"](917.0) == pytest.approx(240e3)


@pytest.mark.parametrize("relation", RELATIONS, ids=lambda relation: relation.name)
def test_every_relation_has_a_source_and_rises(relation):
    assert relation.source and relation.scatter and relation.formula
    first, *other_ranges = relation.ranges.items()
    name, (low, high) = first
    other_inputs = [inner[0] for _, inner in other_ranges]
    values = [relation(low + share * (high - low), *other_inputs) for share in (0.0, 0.5, 1.0)]
    assert values[0] <= values[1] <= values[2]
    assert values[0] < values[2] and min(values) > 0
    assert not relation.outside(low, *other_inputs)
    assert relation.outside(high + 1.0, *other_inputs)[0].startswith(name)


def test_impossible_densities_and_unknown_relations_are_refused():
    with pytest.raises(InputError, match="bergfeld-2023: density 2000 is outside the allowed"):
        YOUNGS_MODULUS["bergfeld-2023"](2000.0)
    with pytest.raises(InputError, match="Young's modulus: 'guess' is unknown; allowed: scapozza"):
        snow_from_density(200.0, youngs_modulus="guess")


def test_snow_from_its_density():
    plain = snow_from_density(150.0)
    assert (plain.density, plain.youngs_modulus) == (
        150.0,
        Snow.preset("calibrated").youngs_modulus,
    )
    snow = snow_from_density(150.0, youngs_modulus="scapozza-2004", tensile_strength="sigrist-2006")
    strength = snow.cohesion * snow.preconsolidation_pressure
    assert strength == pytest.approx(TENSILE_STRENGTH["sigrist-2006"](150.0))
    assert snow.youngs_modulus == pytest.approx(0.1873e6 * math.exp(0.0149 * 150.0))

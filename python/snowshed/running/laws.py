"""Laws of one's own: compiled functions that the material point method calls.

A function may come from numba (``cfunc``), from C by `ctypes`, or be given by its address. It is
called by several threads at once. A Python function behind `ctypes` works, too, but is far too slow
for more than a test.
"""

from __future__ import annotations

import ctypes
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Callable, Optional, Union

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.running.law_digest import code_digest, joint_digest

_DOUBLES = ctypes.POINTER(ctypes.c_double)
_FLOATS = ctypes.POINTER(ctypes.c_float)
_SNOW = ctypes.POINTER(ctypes.c_uint8)

#: Types of the functions for `ctypes`, by the name of the law. Laws of the material have one for
#: each precision of ``numerics.precision``.
LAW_PROTOTYPES = {
    "constitutive_float": ctypes.CFUNCTYPE(
        None, ctypes.c_int64, *[_FLOATS] * 4, _SNOW, ctypes.c_double
    ),
    "constitutive_double": ctypes.CFUNCTYPE(
        None, ctypes.c_int64, *[_DOUBLES] * 4, _SNOW, ctypes.c_double
    ),
    "material_float": ctypes.CFUNCTYPE(
        None, ctypes.c_int64, _FLOATS, _FLOATS, _FLOATS, _SNOW, ctypes.c_double
    ),
    "material_double": ctypes.CFUNCTYPE(
        None, ctypes.c_int64, _DOUBLES, _DOUBLES, _DOUBLES, _SNOW, ctypes.c_double
    ),
    "friction": ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double, ctypes.c_double),
    "body_force": ctypes.CFUNCTYPE(
        None, ctypes.c_int64, *[_DOUBLES] * 3, ctypes.c_double, *[_DOUBLES] * 3
    ),
    "motion": ctypes.CFUNCTYPE(None, ctypes.c_double, _DOUBLES),
}
#: The same types for `numba.cfunc`.
LAW_SIGNATURES = {
    "constitutive_float": "void(int64, CPointer(float32), CPointer(float32), CPointer(float32),"
    " CPointer(float32), CPointer(uint8), float64)",
    "constitutive_double": "void(int64, CPointer(float64), CPointer(float64), CPointer(float64),"
    " CPointer(float64), CPointer(uint8), float64)",
    "material_float": "void(int64, CPointer(float32), CPointer(float32), CPointer(float32),"
    " CPointer(uint8), float64)",
    "material_double": "void(int64, CPointer(float64), CPointer(float64), CPointer(float64),"
    " CPointer(uint8), float64)",
    "friction": "float64(float64, float64)",
    "body_force": "void(int64, CPointer(float64), CPointer(float64), CPointer(float64), float64,"
    " CPointer(float64), CPointer(float64), CPointer(float64))",
    "motion": "void(float64, CPointer(float64))",
}

MAX_OWN_NUMBERS = 8  # as in the core

#: The class of all functions of ctypes.
_FUNCTION: type = ctypes.CFUNCTYPE(None).__mro__[1]

#: A compiled function: of numba (with an ``address``), of ctypes, or its address.
Compiled = Union[int, Callable[..., object]]


@checked
@dataclass(frozen=True)
class Laws:
    """Laws of one's own for a simulation by the material point method.

    Attributes
    ----------
    name
        A name for results and checkpoints, which cannot hold the functions themselves: a run that
        resumes needs laws of the same name. If their code has changed since, a note says so.
    material
        The law of the snow after its elastic trial: ``material(count, p, q, plastic_strain, snow,
        time_step)`` changes the arrays `p` and `q`, pressure and Mises stress [Pa] (Kirchhoff,
        compression positive), and `plastic_strain`, the volumetric plastic strain. A change of p
        by dp changes the plastic strain by dp/K, K the bulk modulus. `snow` has the index of each
        particle's snow. Numbers are of the type of ``numerics.precision``.
    constitutive
        Stress and state of the snow from its elastic trial, in place of its law and its elasticity:
        ``constitutive(count, strain, stress, plastic_strain, own, snow, time_step)``. `strain` is
        the elastic Hencky strain (positive in tension), which the law replaces by its part that
        remains elastic; `stress` receives Kirchhoff's stress [Pa]. Component k of particle i stands
        at ``k * count + i``; components are xx, zz, xz in 2D, and xx, yy, zz, xy, xz, yz in 3D.
        What the trace of the strain loses is added to `plastic_strain`. With a time step of 0 the
        law returns the stress of the given state and changes nothing.
    own_numbers
        Number of values that the constitutive law stores for each particle in `own`, 0 to 8. They
        begin with zero, and checkpoints hold them. Value k of particle i stands at
        ``k * count + i``, and is the field ``own_k`` of a simulation.
    friction
        Coulomb's coefficient of obstacles, by their name: ``friction(speed, normal_stress)``, of
        the sliding speed [m/s] and the normal stress [Pa].
    body_force
        Acceleration in addition to gravity: ``body_force(count, x, y, z, time, ax, ay, az)`` fills
        the last three arrays [m/s2] for positions [m] at a time of the whole run [s].
    motion
        Motion of obstacles, by their name: ``motion(time, pose)`` fills twelve numbers: translation
        [m], rotation vector about the origin [rad], velocity [m/s] and angular velocity [rad/s].

    Raises
    ------
    InputError
        If the name is empty, there is no law, or something is not a compiled function of the right
        type.

    Examples
    --------
    >>> growing = LAW_PROTOTYPES["friction"](lambda speed, stress: 0.2 + 0.1 * speed)
    >>> Laws("faster is rougher", friction={"panel": growing}).name
    'faster is rougher'
    """

    name: str
    material: Optional[Compiled] = None
    friction: Mapping[str, Compiled] = field(default_factory=dict)
    body_force: Optional[Compiled] = None
    motion: Mapping[str, Compiled] = field(default_factory=dict)
    constitutive: Optional[Compiled] = None
    own_numbers: int = 0

    def __post_init__(self) -> None:
        if not self.name or not self.name.isprintable():
            raise InputError(f"name: {self.name!r} is not a name of printable characters")
        self.addresses("double" if self.is_double else "float")
        if self.material is not None and self.constitutive is not None:
            raise InputError("laws: both material and constitutive; give one of them")
        if not 0 <= self.own_numbers <= MAX_OWN_NUMBERS:
            raise InputError(f"own_numbers: {self.own_numbers}; allowed: 0 to {MAX_OWN_NUMBERS}")
        if self.own_numbers and self.constitutive is None:
            raise InputError("own_numbers: only a constitutive law has numbers of its own")
        if not any((self.material, self.constitutive, self.friction, self.body_force, self.motion)):
            raise InputError("laws: there is none; give at least one")

    @property
    def is_double(self) -> bool:
        """Whether the law of the material, if any, takes double precision."""
        material = self._matches("material_double", self.material)
        return material and self._matches("constitutive_double", self.constitutive)

    def addresses(self, precision: str) -> dict[str, object]:
        """Return the addresses of the functions for the core.

        Parameters
        ----------
        precision
            "float" or "double", as in ``numerics.precision``.

        Raises
        ------
        InputError
            If a function is not of its type, such as a law of the material of another precision.
        """
        laws: dict[str, object] = {"name": self.name}
        if self.material is not None:
            laws["material"] = self._address(f"material_{precision}", "material", self.material)
        if self.constitutive is not None:
            kind = f"constitutive_{precision}"
            laws["constitutive"] = self._address(kind, "constitutive", self.constitutive)
            laws["own_numbers"] = self.own_numbers
        if self.body_force is not None:
            laws["body_force"] = self._address("body_force", "body_force", self.body_force)
        for kind in ("friction", "motion"):
            given: Mapping[str, Compiled] = getattr(self, kind)
            if given:
                laws[kind] = {
                    name: self._address(kind, f"{kind} of {name}", function)
                    for name, function in given.items()
                }
        return laws

    def digest(self, precision: str) -> Optional[str]:
        """Return a digest of the functions' code; None if the code of one is unknown.

        `precision` is as for `addresses`, which raises the same errors.
        """
        addresses: dict[str, Any] = self.addresses(precision)
        digests: dict[str, Optional[str]] = {"own_numbers": str(self.own_numbers)}
        for kind in ("material", "constitutive", "body_force"):
            if kind in addresses:
                digests[kind] = code_digest(getattr(self, kind), addresses[kind])
        for kind in ("friction", "motion"):
            for name, place in addresses.get(kind, {}).items():
                digests[f"{kind} {name}"] = code_digest(getattr(self, kind)[name], place)
        return joint_digest(digests)

    def for_core(self, precision: str) -> dict[str, object]:
        """Return the addresses of the functions, with their digest; errors as of `addresses`."""
        return {**self.addresses(precision), "digest": self.digest(precision) or ""}

    def _address(self, kind: str, where: str, function: Compiled) -> int:
        address: Optional[int] = None
        if isinstance(function, int):
            address = function
        elif isinstance(function, _FUNCTION):
            pointer: Any = function
            address = ctypes.cast(pointer, ctypes.c_void_p).value
        else:
            own = getattr(function, "address", None)
            address = own if isinstance(own, int) else None
        if not address:
            raise InputError(
                f"{where}: a value of type {type(function).__name__}; allowed: a function of "
                "numba.cfunc or ctypes, or its address"
            )
        if not self._matches(kind, function):
            wanted = LAW_SIGNATURES[kind]
            raise InputError(f"{where}: the function has other arguments than {wanted}")
        return address

    def _matches(self, kind: str, function: Optional[Compiled]) -> bool:
        """Return whether a function has the types of a law, as far as it states them."""
        if isinstance(function, _FUNCTION):
            pointer: Any = function
            prototype = LAW_PROTOTYPES[kind]
            if getattr(pointer, "argtypes", None) is None:
                return True
            same = list(pointer.argtypes) == list(prototype._argtypes_)
            return same and pointer.restype == prototype._restype_
        signature = getattr(function, "_sig", None)  # of numba
        if signature is None:
            return True
        result, _, arguments = LAW_SIGNATURES[kind].partition("(")
        wanted = re.sub(r"CPointer\((\w+)\)", r"\1*", arguments[:-1]).split(", ")
        returned = str(signature.return_type).replace("none", "void")
        return [str(argument) for argument in signature.args] == wanted and returned == result


def addresses_of(laws: Optional[Laws], scene: Mapping[str, Any]) -> Optional[dict[str, object]]:
    """Return the addresses of laws for a scene, and their digest; None without laws.

    Raises
    ------
    InputError
        If the law of the material is of another precision than the scene.
    """
    if laws is None:
        return None
    return laws.for_core(precision_of(scene))


def precision_of(scene: Mapping[str, Any]) -> str:
    """Return the precision of a scene's numbers, "float" or "double", as `Laws.addresses` has it.

    Examples
    --------
    >>> precision_of({"numerics": {"precision": "float"}}), precision_of({"numerics": {}})
    ('float', 'double')
    """
    return str(scene["numerics"].get("precision", "double"))

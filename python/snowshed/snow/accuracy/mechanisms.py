"""Mechanisms of a run: its scheme, and how its settings depart from those of the scheme.

The error of a run holds for another run only if both have the same mechanisms.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any, Optional

from snowshed.base.formatting import percent
from snowshed.methods.mpm.settings import MpmSettings
from snowshed.methods.registry import SETTINGS_KEY, settings_of
from snowshed.scene.scene import Scene
from snowshed.snow.accuracy.measurements import CaseSettings, Value
from snowshed.snow.accuracy.recorded_stacks import PRESET
from snowshed.snow.accuracy.setting_labels import settings_label

SCHEME = "scheme"
#: The scheme of recorded runs that do not name it.
FIRST_SCHEME = "thesis"
#: Settings that a scheme decides unless they are given.
SCHEME_SETTINGS = MpmSettings.ADOPTS[SCHEME]
#: Those of them that are lengths, m; they do not scale with the slab.
LENGTHS = ("damping_length", "crack_band_length")


@dataclass(frozen=True)
class Mechanisms:
    """A scheme, and the settings that depart from it.

    Attributes
    ----------
    scheme
        Name of the scheme.
    overrides
        Settings that the scheme decides, if their values are not the scheme's.
    """

    scheme: str = FIRST_SCHEME
    overrides: Mapping[str, Value] = field(default_factory=dict)

    @classmethod
    def of_scene(cls, scene: Mapping[str, Any]) -> Optional[Mechanisms]:
        """Return the mechanisms of a resolved scene; None if its method is not the MPM.

        Examples
        --------
        >>> lab = Scene.preset("lab-50").with_({"numerics.transfer": "affine_flip"})
        >>> Mechanisms.of_scene(lab.resolve().data).label
        'scheme thesis with affine flip'
        """
        if not isinstance(settings_of(scene), MpmSettings):
            return None
        return cls.of_settings(scene[SETTINGS_KEY])

    @classmethod
    def of_settings(cls, settings: Mapping[str, Any]) -> Mechanisms:
        """Return the mechanisms of settings, named without section; missing ones are defaults.

        Examples
        --------
        >>> Mechanisms.of_settings({"dx": 0.01, "transfer": "flip"}).label
        'scheme thesis'
        >>> Mechanisms.of_settings({"scheme": "objective", "damping_length": 0.02}).label
        'scheme objective with damping length 0.02'
        """
        scheme = scheme_of(settings)
        decided = scheme_defaults(scheme)
        overrides = {
            name: settings[name]
            for name in SCHEME_SETTINGS
            if settings.get(name) is not None and settings[name] != decided.get(name)
        }
        return cls(scheme, overrides)

    @classmethod
    def of_texts(cls, texts: Mapping[str, str]) -> Mechanisms:
        """Return the mechanisms of settings whose values are texts, as in a table of a study.

        Examples
        --------
        >>> Mechanisms.of_texts({"transfer": "flip", "flip_ratio": "0.95", "damping_rate": "nan"})
        Mechanisms(scheme='thesis', overrides={'flip_ratio': 0.95})
        """
        return cls.of_settings({name: _value(text) for name, text in texts.items()})

    @property
    def label(self) -> str:
        """The name of the scheme, with the departures from it."""
        overrides = settings_label(self.overrides)
        return f"scheme {self.scheme}" + (f" with {overrides}" if overrides else "")

    @property
    def calibration_note(self) -> str:
        """A clause on the scheme with which the snow was calibrated; empty for that scheme.

        Examples
        --------
        >>> Mechanisms("objective").calibration_note
        'the snow was calibrated with scheme thesis on cells of 1 cm, which stacks it higher'
        >>> Mechanisms().calibration_note
        ''
        """
        if self.scheme == FIRST_SCHEME:
            return ""
        calibrated_with = f"scheme {FIRST_SCHEME} on cells of 1 cm"
        return f"the snow was calibrated with {calibrated_with}, which stacks it higher"

    def lengths_note(self, recorded: float, thickness: float) -> str:
        """Return a clause if the slab is thicker or thinner than the recorded one by a percent.

        Parameters
        ----------
        recorded, thickness
            Thickness of the recorded slab and of the other one, m.

        Returns
        -------
        str
            A clause; empty if the scheme has no lengths, or their share is the same.

        Examples
        --------
        >>> Mechanisms("objective").lengths_note(0.02, 0.2)
        "the scheme's lengths (0.01 m) are 50 % of the recorded slab's thickness, 5 % of this one's"
        >>> Mechanisms("objective").lengths_note(0.02, 0.02), Mechanisms().lengths_note(0.02, 0.2)
        ('', '')
        """
        decided = scheme_defaults(self.scheme)
        length = max(float(decided[name]) for name in LENGTHS)
        if not length or abs(thickness / recorded - 1) < 0.01:
            return ""
        recorded_share = percent(length / recorded, 2)
        own_share = percent(length / thickness, 2)
        lengths = f"the scheme's lengths ({length:g} m)"
        return (
            f"{lengths} are {recorded_share} of the recorded slab's thickness, "
            f"{own_share} of this one's"
        )


def scheme_of(settings: Mapping[str, Any]) -> str:
    """Return the scheme of settings; recorded runs of the first scheme do not name it.

    Examples
    --------
    >>> scheme_of({"dx": 0.01}), scheme_of({"scheme": "objective"})
    ('thesis', 'objective')
    """
    return str(settings.get(SCHEME) or FIRST_SCHEME)


@lru_cache(maxsize=8)
def scheme_defaults(scheme: str) -> CaseSettings:
    """Return the settings that a scheme decides.

    Examples
    --------
    >>> scheme_defaults("thesis")["transfer"], scheme_defaults("objective")["damping_length"]
    ('flip', 0.01)
    """
    scene = Scene.preset(PRESET).with_({f"{SETTINGS_KEY}.{SCHEME}": scheme})
    numerics = scene.resolve().data[SETTINGS_KEY]
    return {name: numerics[name] for name in SCHEME_SETTINGS if name in numerics}


def _value(text: str) -> Optional[Value]:
    """Return a cell as a number, else as a text; None for an empty cell."""
    if text in ("", "nan", "None"):
        return None
    try:
        return float(text)
    except ValueError:
        return text

from .material.fit import fit_material as fit_material
from .material.law import CamClayFit as CamClayFit
from .material.yield_surface import fit_yield_surface as fit_yield_surface
from .ratios import compare_variants as compare_variants
from .samples import LabelledSample as LabelledSample
from .sensitivity import evaluate_variants as evaluate_variants
from .variants import sensitivity_variants as sensitivity_variants

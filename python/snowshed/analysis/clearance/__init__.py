"""The height of a panel's lower edge that its shed snow does not reach."""

from snowshed.analysis.clearance.answer import Answer, clearance_of
from snowshed.analysis.clearance.design import Design, Ranges
from snowshed.analysis.clearance.winters import Winter, winters_of

__all__ = ["Answer", "Design", "Ranges", "Winter", "clearance_of", "winters_of"]

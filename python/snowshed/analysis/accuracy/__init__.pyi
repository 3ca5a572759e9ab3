from .stack_errors import StackError as StackError
from .stack_errors import stack_error as stack_error

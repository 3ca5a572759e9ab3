"""Linear algebra on one thread, also by libraries that are not loaded yet."""

import subprocess
import sys

LATE = """
from snowshed.analysis.regression.threads import one_thread

with one_thread():
    import scipy.linalg, sklearn.svm
    from threadpoolctl import threadpool_info

    print(max(library["num_threads"] for library in threadpool_info()))
"""


def test_libraries_loaded_later_use_one_thread_too():
    code = [sys.executable, "-c", LATE]
    result = subprocess.run(code, capture_output=True, text=True, timeout=120)
    assert result.stdout == "1\n", result.stderr

"""The tests of this folder share the independent version of the step that lies beside them."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))  # numpy_step, laws

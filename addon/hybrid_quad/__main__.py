"""``python -m hybrid_quad`` is ``hybrid-quad``."""

import sys

from .cli.program import main

sys.exit(main())

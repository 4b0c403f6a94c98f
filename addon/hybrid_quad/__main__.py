"""``python -m hybrid_quad`` is ``hybrid-quad``."""

import sys

from .cli.main import main

sys.exit(main())

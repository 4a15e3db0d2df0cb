"""Reading STEP and IGES: ``reader`` asks ``xcaf`` in a guarded process and makes the scene of its answers."""

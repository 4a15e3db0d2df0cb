"""What the USD target asks of usd-core, as plain objects, so that what it writes is compared where usd-core is not installed."""

"""Links of articulations in the place of bodies and joints."""

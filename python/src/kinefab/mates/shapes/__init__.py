"""What single parts offer: bores, shafts and flats, turned forms, teeth; and where parts are near each other."""

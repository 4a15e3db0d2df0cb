"""SolidWorks, over COM."""

"""What a planned session lets expect: cameras, walk, tie points, predicted error."""

"""The snow's constitutive law along paths of strain."""

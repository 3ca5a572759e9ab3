"""The thesis's claims as functions of tables: data in, verdict and sentence out."""

"""The equations y = X b + e of all training records, as wide a band as the encoders allow."""

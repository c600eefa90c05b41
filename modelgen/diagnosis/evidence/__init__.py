"""What a column explains beyond the noise: whitening, likelihood ratios, instruments."""

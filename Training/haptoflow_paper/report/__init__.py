"""The page, table and charts that the measured rows become."""

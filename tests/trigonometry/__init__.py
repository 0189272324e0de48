"""The sine, cosine and arc tangent of batches: where the numbers come from, and how far the results are off."""

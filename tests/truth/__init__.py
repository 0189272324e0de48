"""Everything that is generated, judged by numbers that were reached another way."""

"""The misprints of S1, each beside its correction and beside a truth that knows neither."""

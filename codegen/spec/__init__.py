"""What is asked for: frozen, validated data; no algebra."""

"""The intermediate representation: a frozen scalar program in static single assignment."""

"""How operations are priced."""

from fractions import Fraction

from codegen.ir.builder import Builder
from codegen.ir.ops import Op
from codegen.ir.program import Argument, Output, Program, Sparsity
from codegen.passes.contract_fma import contract_fma
from flopcount.counts import Counts
from flopcount.models import FMA, MODELS, MULTIPLY, PAPER, Operations, contractions, measured


def program_of(build) -> Program:
    """A program of one output over x[4]; ``build`` appends it and gives the position of the value."""
    builder = Builder()
    inputs = [builder.input("x", k) for k in range(4)]
    value = build(builder, inputs)
    output = Output("y", Sparsity.of_entries(1, 1, [(0, 0)]), (value,))
    return builder.freeze((Argument("x", (4, 1)),), (output,))


def scalar_product(builder: Builder, x: list[int]) -> int:
    """x0 x1 + x2 x3."""
    products = [builder.emit(Op.MULTIPLY, x[0], x[1]), builder.emit(Op.MULTIPLY, x[2], x[3])]
    return builder.emit(Op.ADD, *products)


def test_an_addition_absorbs_one_product_only():
    assert contractions(program_of(scalar_product)) == 1


def test_a_product_that_is_used_twice_cannot_be_absorbed():
    def square_sum(builder, x):
        product = builder.emit(Op.MULTIPLY, x[0], x[1])
        return builder.emit(Op.MULTIPLY, builder.emit(Op.ADD, product, x[2]), product)

    assert contractions(program_of(square_sum)) == 0


def test_a_product_that_is_an_output_cannot_be_absorbed():
    builder = Builder()
    x = [builder.input("x", k) for k in range(3)]
    product = builder.emit(Op.MULTIPLY, x[0], x[1])
    total = builder.emit(Op.ADD, product, x[2])
    output = Output("y", Sparsity.of_entries(2, 1, [(0, 0), (1, 0)]), (product, total))
    assert contractions(builder.freeze((Argument("x", (3, 1)),), (output,))) == 0


def test_the_models_price_a_scalar_product_as_they_say():
    operations = Operations.of(program_of(scalar_product))
    assert operations.counts == Counts(add=1, mul=2)
    assert PAPER.price(operations) == 3
    assert MULTIPLY.price(operations) == 2
    assert FMA.price(operations) == 2
    assert measured({"add": 1.0, "mul": 1.5}).price(operations) == 4.0


def test_a_fused_scalar_product_has_the_price_of_what_it_does():
    fused = Operations.of(contract_fma(program_of(scalar_product)))
    assert fused.counts == Counts(mul=1, fma=1)
    assert (fused.counts.total, fused.counts.arithmetic, fused.counts.roundings) == (3, 3, 2)
    assert (PAPER.price(fused), MULTIPLY.price(fused), FMA.price(fused)) == (3, 2, 2)
    assert measured({"mul": 1.5, "fma": 2.0}).price(fused) == 3.5


def test_a_change_of_sign_is_free_in_every_model():
    operations = Operations.of(program_of(lambda builder, x: builder.emit(Op.NEGATE, x[0])))
    assert all(model.price(operations) == 0 for model in MODELS.values())


def test_constants_and_inputs_are_free_in_every_model():
    operations = Operations.of(program_of(lambda builder, x: builder.constant(Fraction(1, 3))))
    assert all(model.price(operations) == 0 for model in MODELS.values())

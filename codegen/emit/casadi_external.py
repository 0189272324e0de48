"""The C routines as CasADi externals, with ``jac_`` functions from the exact derivative of the same program.

``casadi.external`` reads inputs, outputs and patterns from functions of fixed names beside the routine's own; what it
needs of the derivative is the function ``jac_NAME``, one block for each output and input.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from codegen.emit.c import any_definition
from codegen.emit.environment import render
from codegen.emit.packed import packed
from codegen.emit.parameters import parameters
from codegen.emit.platform_subject import PlatformSubject
from codegen.emit.routine import Routine
from codegen.ir.looped import Looped
from codegen.ir.program import Argument, Program, Result, Sparsity
from codegen.passes import simplify
from codegen.passes.contract_fma import contract_fma
from codegen.passes.differentiate import differentiate
from codegen.passes.differentiate_looped import differentiate_looped

EXTERNALS = ("phi", "phi_q_v", "phi_q_t_lambda")
"""The quantities that residuals are made of: those that a solver differentiates."""

SMOOTH = {"lengths": "", "D": "", "det": "", "C": "smooth"}
"""The quantities of platforms that have a derivative wherever the pose is not singular -> the variant that it takes.

C of the other variants has none where its greatest or least value is repeated.
"""


@dataclass(frozen=True, slots=True)
class Port:
    """An input or output of an external.

    Attributes:
        name: as in the C signature.
        length: number of stored entries.
        pattern: rows of numbers {nrow, ncol, colind..., row...}.
    """

    name: str
    length: int
    pattern: tuple[str, ...]

    @property
    def quoted(self) -> str:
        """The name as a C string."""
        return f'"{self.name}"'


@dataclass(frozen=True, slots=True)
class External:
    """One function in CasADi's calling convention.

    Attributes:
        name: by which ``casadi.external`` finds it.
        symbol: the C routine behind it.
        inputs: what CasADi passes.
        called_inputs: which of them the routine takes.
        outputs: what it returns.
    """

    name: str
    symbol: str
    inputs: tuple[Port, ...]
    called_inputs: tuple[int, ...]
    outputs: tuple[Port, ...]

    @property
    def longest_input(self) -> int:
        """Length of the longest input."""
        return max(port.length for port in self.inputs)


def has_external(routine: Routine) -> bool:
    """Whether there is an external: a single quantity that a solver differentiates and that depends on something."""
    if not routine.program.used_arguments():
        return False
    if isinstance(routine.subject, PlatformSubject):
        variant = SMOOTH.get(routine.output)
        return variant is not None and variant in ("", routine.subject.platform.wanted.variant)
    return routine.output in EXTERNALS


def external_name(stem: str, output: str) -> str:
    """Name of the external of a routine."""
    return f"{stem}_{output}_external"


def external_source(
    routines: Sequence[Routine], file: str, header: str, banner: str, options: str, specification: str
) -> str:
    """Write the externals of the routines of a file as one C source."""
    jacobians, externals = [], []
    for routine in routines:
        if has_external(routine):
            jacobian = _derivative(routine)
            symbol = f"{routine.symbol}_jacobian"
            declared = parameters(routine, False, jacobian)
            jacobians.append(any_definition(symbol, declared, jacobian, routine.subject, "static void")[0])
            externals += [_function(routine), _jacobian(routine, jacobian, symbol)]
    return render(
        "casadi/external.c.j2",
        file=file,
        banner=banner,
        options=options,
        specification=specification,
        header=header,
        jacobians=jacobians,
        externals=externals,
    )


def _derivative(routine: Routine) -> Program | Looped:
    if isinstance(routine.program, Looped):
        return differentiate_looped(routine.program)
    jacobian = simplify(differentiate(routine.program))
    return contract_fma(jacobian) if routine.counts.fma else jacobian


def _function(routine: Routine) -> External:
    inputs = _inputs(routine.program)
    outputs = tuple(_output(output) for output in routine.program.outputs)
    return External(
        external_name(routine.subject.stem, routine.output), routine.symbol, inputs, tuple(range(len(inputs))), outputs
    )


def _jacobian(routine: Routine, jacobian: Program | Looped, symbol: str) -> External:
    """CasADi passes the inputs and the nominal outputs, and wants one block for each output and input."""
    nominal = tuple(
        Port(f"out_{output.name}", 0, _pattern(Sparsity.of_entries(output.sparsity.nrow, output.sparsity.ncol, ())))
        for output in routine.program.outputs
    )
    inputs = _inputs(routine.program)
    names = [port.name for port in inputs]
    called = tuple(names.index(argument.name) for argument in jacobian.used_arguments())
    outputs = tuple(_output(output) for output in jacobian.outputs)
    return External(
        f"jac_{external_name(routine.subject.stem, routine.output)}", symbol, inputs + nominal, called, outputs
    )


def _inputs(program: Program | Looped) -> tuple[Port, ...]:
    return tuple(
        Port(argument.name, argument.length, _pattern(_dense(argument))) for argument in program.used_arguments()
    )


def _dense(argument: Argument) -> Sparsity:
    nrow, ncol = argument.shape
    return Sparsity.of_entries(nrow, ncol, [(row, column) for row in range(nrow) for column in range(ncol)])


def _output(output: Result) -> Port:
    return Port(output.name, output.sparsity.nonzeros, _pattern(output.sparsity))


def _pattern(pattern: Sparsity) -> tuple[str, ...]:
    numbers = (pattern.nrow, pattern.ncol, *pattern.colind, *pattern.row)
    return tuple(packed([str(number) for number in numbers], 108))

namespace Kinefab.Dynamics.Rattle;

/// <summary>What a step whose parts fail is tried with, one after the other.</summary>
internal enum Resort
{
    /// <summary>RATTLE, in halves of what fails.</summary>
    None,

    /// <summary>The same, with the drives without limit of force asked for less: at a dead point they are what fails.</summary>
    SlowerDrives,

    /// <summary>A <see cref="ProjectedStep"/> for each part that fails, long ones first.</summary>
    Projection,

    /// <summary>From the step's start in halves alone, as long projected parts led where nothing goes on.</summary>
    Halves,
}

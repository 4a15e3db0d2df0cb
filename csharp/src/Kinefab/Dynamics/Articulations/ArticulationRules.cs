namespace Kinefab.Dynamics.Articulations;

/// <summary>
/// Where PhysX 5 treats a reduced-coordinate articulation otherwise than PhysX 4.1, which Unity ships. Both sources are public
/// (NVIDIAGameWorks/PhysX and NVIDIA-Omniverse/PhysX, DyFeatherstoneArticulation.cpp and DyFeatherstoneForwardDynamic.cpp); 5.6.1 can be run
/// outside Unity and is what the traces were made with.
/// </summary>
internal sealed record ArticulationRules
{
    /// <summary>As Unity 2021.2 to 6000 has them.</summary>
    public static readonly ArticulationRules PhysX4 = new()
    {
        Compliance = 1e-4,
        ComplianceShare = 0,
        LimitShare = 1,
        LimitsHoldInVelocityIterations = false,
        ClampsTargets = true,
        ScalesSpeedsTogether = false,
        KeepsMomentum = false,
        DrivesSphericalByRotation = false,
    };

    /// <summary>As PhysX 5.6.1 has them.</summary>
    public static readonly ArticulationRules PhysX5 = new()
    {
        Compliance = 0,
        ComplianceShare = 0.025,
        LimitShare = 0.8,
        LimitsHoldInVelocityIterations = true,
        ClampsTargets = false,
        ScalesSpeedsTogether = true,
        KeepsMomentum = true,
        DrivesSphericalByRotation = true,
    };

    /// <summary>Added to the response of friction, limits, speed limits and acceleration drives, 1/kg or 1/(kg m^2). 4.1: DY_ARTICULATION_CFM.</summary>
    public double Compliance { get; init; }

    /// <summary>Added as well: this share of the links' largest linear response. 5: cfmScale, computeArticulatedResponseMatrix.</summary>
    public double ComplianceShare { get; init; }

    /// <summary>Share of a passed limit that one step takes back. 4.1: erp 1; 5: DY_ARTICULATION_PGS_BIAS_COEFFICIENT.</summary>
    public double LimitShare { get; init; }

    /// <summary>4.1 lets limits only give back in velocity iterations; 5 holds them there, too.</summary>
    public bool LimitsHoldInVelocityIterations { get; init; }

    /// <summary>4.1 drives no farther than the limits; 5 leaves that to the limit.</summary>
    public bool ClampsTargets { get; init; }

    /// <summary>Above the speed limit 5 slows all joints by one factor at the start of a step and each in the sweeps; 4.1 each joint alone, before and after forces.</summary>
    public bool ScalesSpeedsTogether { get; init; }

    /// <summary>5 gives a floating articulation back the momentum that the step's own terms would take.</summary>
    public bool KeepsMomentum { get; init; }

    /// <summary>A spherical drive's gap: 5 takes twice the vector part of the rotation that is left, 4.1 each axis by itself.</summary>
    public bool DrivesSphericalByRotation { get; init; }
}

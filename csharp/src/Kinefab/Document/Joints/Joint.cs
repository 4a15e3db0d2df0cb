using System;
using System.Collections.Generic;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>A joint between the Rigidbody of its own GameObject and another one, or the world.</summary>
public abstract record Joint : Component
{
    private protected static readonly string[] JointFields =
    [
        "connectedBody", "breakForce", "breakTorque", "enableCollision", "enablePreprocessing", "massScale",
        "connectedMassScale", "because", "closure", "exact",
    ];

    private int? connectedBody;
    private double breakForce = double.PositiveInfinity;
    private double breakTorque = double.PositiveInfinity;
    private bool enableCollision;
    private bool enablePreprocessing = true;
    private double massScale = 1;
    private double connectedMassScale = 1;
    private IReadOnlyList<string> because = Array.Empty<string>();
    private bool closure;
    private bool exact = true;

    private protected Joint()
    {
    }

    /// <summary>Index of the GameObject whose Rigidbody is connected; null: the world.</summary>
    public int? ConnectedBody
    {
        get => connectedBody;
        init => connectedBody = value;
    }

    /// <summary>N; infinite: unbreakable.</summary>
    public double BreakForce
    {
        get => breakForce;
        init => breakForce = value;
    }

    /// <summary>N m; infinite: unbreakable.</summary>
    public double BreakTorque
    {
        get => breakTorque;
        init => breakTorque = value;
    }

    /// <summary>Whether the two bodies collide with each other.</summary>
    public bool EnableCollision
    {
        get => enableCollision;
        init => enableCollision = value;
    }

    /// <summary>PhysX's preprocessing; off helps over-constrained set-ups.</summary>
    public bool EnablePreprocessing
    {
        get => enablePreprocessing;
        init => enablePreprocessing = value;
    }

    /// <summary>Scale on the INVERSE mass and inertia of the own body.</summary>
    public double MassScale
    {
        get => massScale;
        init => massScale = value;
    }

    /// <summary>Scale on the INVERSE mass and inertia of the connected body.</summary>
    public double ConnectedMassScale
    {
        get => connectedMassScale;
        init => connectedMassScale = value;
    }

    /// <summary>Source constraints or joints that this one comes from.</summary>
    public IReadOnlyList<string> Because
    {
        get => because;
        init => because = value;
    }

    /// <summary>Closes a loop: the spanning tree does not need it.</summary>
    public bool Closure
    {
        get => closure;
        init => closure = value;
    }

    /// <summary>False where the component only approximates the source's relation.</summary>
    public bool Exact
    {
        get => exact;
        init => exact = value;
    }

    /// <summary>What it holds its body to, and what breaks it.</summary>
    private protected string Ends =>
        Line($"to {(ConnectedBody is int body ? $"object {body}" : "the world")}{(BreakForce < double.PositiveInfinity ? $", breaks at {BreakForce} N" : "")}{(BreakTorque < double.PositiveInfinity ? $", breaks at {BreakTorque} N m" : "")}{(Closure ? ", closes a loop" : "")}");

    private protected void ReadJointField(ref JsonCursor json, string field)
    {
        switch (field)
        {
            case "connectedBody":
                connectedBody = json.Int();
                break;
            case "breakForce":
                breakForce = json.Number();
                break;
            case "breakTorque":
                breakTorque = json.Number();
                break;
            case "enableCollision":
                enableCollision = json.Boolean();
                break;
            case "enablePreprocessing":
                enablePreprocessing = json.Boolean();
                break;
            case "massScale":
                massScale = json.Number();
                break;
            case "connectedMassScale":
                connectedMassScale = json.Number();
                break;
            case "because":
                because = json.List(static (ref JsonCursor at) => at.Text());
                break;
            case "closure":
                closure = json.Boolean();
                break;
            case "exact":
                exact = json.Boolean();
                break;
        }
    }
}

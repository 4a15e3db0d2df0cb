using System;
using System.IO;
using System.Linq;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Numerics;
using Kinefab.Tests.Conformance;
using Kinefab.Tests.Document;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Validation;

public class ValidSceneTests
{
    private static readonly float[] TetrahedronPositions = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1];

    [Test]
    public void World_TurnedAndScaledParent_PlacesTheChildAsUnityDoes()
    {
        ValidScene scene = Validate(
            new GameObject { Id = "a", Transform = new Transform { LocalPosition = new(1, 2, 3), LocalRotation = new(0, Math.Sqrt(0.5), 0, Math.Sqrt(0.5)), LocalScale = new(2, 2, 2) } },
            new GameObject { Id = "b", Parent = 0, Transform = new Transform { LocalPosition = new(0, 0, 0.5), LocalScale = new(1, 3, 1) } });
        WorldTransform child = scene.WorldTransform(1);
        // Yaw of 90 degrees turns forward to right: 2 * 0.5 along +X.
        using (Assert.EnterMultipleScope())
        {
            Assert.That((child.Pose.Position - new Vector3d(2, 2, 3)).Length, Is.LessThan(1e-15));
            Assert.That(child.Scale, Is.EqualTo(new Vector3d(2, 6, 2)));
        }
    }

    [TestCaseSource(typeof(SceneWithNull), nameof(SceneWithNull.All))]
    public void Validate_DocumentWithANull_SaysWhere(string place, string expected, SceneDocument document)
    {
        SceneValidation validation = SceneValidator.Validate(document);
        Assert.That(validation.Scene, Is.Null);
        Assert.That(validation.Report.Diagnostics.Select(found => (found.Code, found.Pointer)), Is.EqualTo(new[] { (DiagnosticCodes.TypeMismatch, place) }));
        Assert.That(validation.Report.Diagnostics[0].Message, Is.EqualTo($"There is null where {expected} belongs."));
    }

    [TestCase(true)]
    [TestCase(false)]
    public void Validate_RendererWithTooFewMaterials_IsToldOnWhicheverSideOfItsMesh(bool isMeshFirst)
    {
        Component[] components = isMeshFirst ? [new MeshFilter(), new MeshRenderer()] : [new MeshRenderer(), new MeshFilter()];
        var document = new SceneDocument
        {
            Meshes = [new Mesh { VertexCount = 3, Submeshes = [new Submesh { IndexCount = 3 }] }],
            GameObjects = [new GameObject { Id = "shown", Components = components }],
        };
        Assert.That(SceneValidator.Validate(document).Report.Diagnostics.Select(found => found.Code), Does.Contain(DiagnosticCodes.RendererMaterialCount));
    }

    [TestCase(false, 180)]
    [TestCase(true, 270)]
    public void Freedoms_OfAHingeBeyondHalfATurn_AreWhatUnityTakes(bool isExtended, double upper)
    {
        ValidScene scene = Validate(new GameObject { Id = "a", Components = [new Rigidbody(), new HingeJoint { UseLimits = true, ExtendedLimits = isExtended, Limits = new JointLimits { Min = -20, Max = 270 } }] });
        JointFreedom found = scene.Freedoms(0, 1).Single();
        Assert.That((found.Lower, found.Upper), Is.EqualTo((-20.0, upper)));
    }

    [TestCase(0, double.NaN)]
    [TestCase(0, double.NegativeInfinity)]
    [TestCase(1, double.PositiveInfinity)]
    public void Validate_AnAnimationsTimeThatIsNone_IsAnError(int at, double time)
    {
        double[] times = [0, 1];
        times[at] = time;
        var document = new SceneDocument { GameObjects = [new GameObject { Id = "a" }], Animations = [new AnimationClip { Name = "clip", Times = at == 0 ? times[..1] : times }] };
        Assert.That(SceneValidator.Validate(document).Report.Diagnostics.Select(found => (found.Code, found.Pointer)), Is.EqualTo([(DiagnosticCodes.NumberNotFinite, $"/animations/0/times/{at}")]));
    }

    [Test]
    public void BodyOf_ColliderBelowABody_IsTheNearestAncestorsBody()
    {
        ValidScene scene = Validate(
            new GameObject { Id = "loose" },
            new GameObject { Id = "body", Components = [new Rigidbody()] },
            new GameObject { Id = "child", Parent = 1, Components = [new SphereCollider()] });
        Assert.That((scene.BodyOf(0), scene.BodyOf(1), scene.BodyOf(2)), Is.EqualTo(((int?)null, (int?)1, (int?)1)));
    }

    [TestCase(false, false, 0.5, -0.25, -1)]
    [TestCase(false, true, 0.5, -1, 0.25)]
    [TestCase(true, false, 0, 0, 0)]
    public void AnchorGap_OfASlide_IsFromTheConnectedAnchorToTheOwn(bool automatic, bool turnedAxes, double x, double y, double z)
    {
        var joint = new ConfigurableJoint
        {
            ConnectedBody = 0,
            Anchor = new Vector3d(0.5, 0, 0),
            AutoConfigureConnectedAnchor = automatic,
            ConnectedAnchor = new Vector3d(2, 0.25, 1),
            Axis = Vector3d.UnitX,
            SecondaryAxis = turnedAxes ? Vector3d.UnitZ : Vector3d.UnitY,
        };
        ValidScene scene = Validate(
            new GameObject { Id = "base", Components = [new Rigidbody()] },
            new GameObject { Id = "slide", Transform = new Transform { LocalPosition = new(2, 0, 0) }, Components = [new Rigidbody(), joint] });
        Assert.That((scene.AnchorGap(1, 1) - new Vector3d(x, y, z)).Length, Is.LessThan(1e-15));
        Assert.That(() => scene.AnchorGap(1, 0), Throws.InstanceOf<ArgumentOutOfRangeException>());
    }

    [Test]
    public void Mesh_OfALoadedScene_ShowsTheNumbersOfTheBuffer()
    {
        ValidScene scene = ValidScene.Load(Path.Combine(ConformanceCases.Folder, "valid", "mesh", "uint32.kinefab"));
        MeshData mesh = scene.Mesh(0);
        float[] positions = mesh.Positions.ToArray(), normals = mesh.Normals.ToArray(), uv = mesh.Uv.ToArray();
        uint[] indices = mesh.Indices32.ToArray();
        using (Assert.EnterMultipleScope())
        {
            Assert.That(positions, Is.EqualTo(TetrahedronPositions));
            Assert.That(indices, Is.EqualTo([0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]));
            Assert.That(normals, Is.EqualTo(Enumerable.Repeat<float[]>([0, 0, -1], 4).SelectMany(normal => normal)));
            Assert.That(uv, Is.EqualTo([0, 0, 1, 0, 0, 1, 1, 1]));
            Assert.That(scene.Mesh(0).Indices16.Length, Is.Zero);
        }
    }

    [Test]
    public void Mesh_OfALoadedScene_IsNoCopy()
    {
        ValidScene scene = ValidScene.Load(Path.Combine(ConformanceCases.Folder, "valid", "mesh", "uint16.kinefab"));
        ReadOnlySpan<byte> buffer = scene.Document.Buffers[0].Data!.Value.Span;
        Assert.That(System.Runtime.InteropServices.MemoryMarshal.AsBytes(scene.Mesh(0).Positions).Overlaps(buffer));
    }

    [Test]
    public void Freedoms_SliderWithShiftedAnchor_AreTheRangeOfTheCoordinate()
    {
        ValidScene scene = ValidScene.Load(Path.Combine(ConformanceCases.Folder, "valid", "configurable", "slider.kinefab"));
        JointFreedom slide = scene.Freedoms(1, 1).Single();
        using (Assert.EnterMultipleScope())
        {
            Assert.That((slide.Coordinate, slide.IsAngle), Is.EqualTo((Coordinate.X, false)));
            Assert.That(slide.Lower, Is.EqualTo(-0.02).Within(1e-12));
            Assert.That(slide.Upper, Is.EqualTo(0.12).Within(1e-12));
        }
    }

    [TestCase(false, -80, 10)]
    [TestCase(true, -10, 80)]
    public void Freedoms_AngularXLimits_TurnOverForTheOwnBodyUnlessSwapped(bool swap, double lower, double upper)
    {
        var joint = new ConfigurableJoint
        {
            XMotion = ConfigurableJointMotion.Locked, YMotion = ConfigurableJointMotion.Locked, ZMotion = ConfigurableJointMotion.Locked,
            AngularXMotion = ConfigurableJointMotion.Limited, AngularYMotion = ConfigurableJointMotion.Locked, AngularZMotion = ConfigurableJointMotion.Locked,
            LowAngularXLimit = new SoftJointLimit { Limit = -10 }, HighAngularXLimit = new SoftJointLimit { Limit = 80 }, SwapBodies = swap,
        };
        JointFreedom twist = Validate(new GameObject { Id = "a", Components = [new Rigidbody(), joint] }).Freedoms(0, 1).Single();
        Assert.That((twist.Coordinate, twist.Lower, twist.Upper), Is.EqualTo((Coordinate.AngularX, lower, upper)));
    }

    [Test]
    public void Load_SceneWithErrors_ThrowsWithTheReport()
    {
        string path = Path.Combine(ConformanceCases.Folder, "invalid", "joint", "axis_zero.kinefab");
        var thrown = Assert.Throws<SceneFormatException>(() => ValidScene.Load(path))!;
        Assert.That(thrown.Report.Diagnostics.Single().Code, Is.EqualTo(DiagnosticCodes.JointAxisZero));
    }

    [TestCase(double.NaN)]
    [TestCase(double.PositiveInfinity)]
    [TestCase(-1)]
    public void Validate_DocumentMadeInCode_ReportsWithoutLines(double mass)
    {
        var document = new SceneDocument { GameObjects = [new GameObject { Id = "a", Components = [new Rigidbody { Mass = mass }] }] };
        Diagnostic found = SceneValidator.Validate(document).Report.Diagnostics.Single();
        Assert.That(
            (found.Code, found.Pointer, found.Line),
            Is.EqualTo((DiagnosticCodes.BodyMassNotPositive, "/gameObjects/0/components/0/mass", (int?)null)));
    }

    private static ValidScene Validate(params GameObject[] objects) =>
        SceneValidator.Validate(new SceneDocument { GameObjects = objects }).Scene!;
}

namespace Kinefab.Numerics;

/// <summary>A symmetric 3 x 3 matrix; stored as xx, yy, zz, xy, xz, yz.</summary>
internal readonly struct Symmetric3
{
    private readonly double _xx, _yy, _zz, _xy, _xz, _yz;

    public Symmetric3(double xx, double yy, double zz, double xy, double xz, double yz)
    {
        _xx = xx;
        _yy = yy;
        _zz = zz;
        _xy = xy;
        _xz = xz;
        _yz = yz;
    }

    public static Symmetric3 Load(double[] array, int index) =>
        new(array[index], array[index + 1], array[index + 2], array[index + 3], array[index + 4], array[index + 5]);

    public void Store(double[] array, int index)
    {
        array[index] = _xx;
        array[index + 1] = _yy;
        array[index + 2] = _zz;
        array[index + 3] = _xy;
        array[index + 4] = _xz;
        array[index + 5] = _yz;
    }

    /// <summary>
    /// (B^-1 + K)^-1 = (1 + B K)^-1 B for positive semi-definite B and K, without inverting B, which may be singular.
    /// </summary>
    public static Symmetric3 InverseOfSum(Symmetric3 b, Symmetric3 k)
    {
        // n = 1 + B K by columns; its rows' cofactors give the inverse.
        Vector3d c0 = Vector3d.UnitX + b.Times(k.Column0);
        Vector3d c1 = Vector3d.UnitY + b.Times(k.Column1);
        Vector3d c2 = Vector3d.UnitZ + b.Times(k.Column2);
        Vector3d r0 = Vector3d.Cross(c1, c2);
        Vector3d r1 = Vector3d.Cross(c2, c0);
        Vector3d r2 = Vector3d.Cross(c0, c1);
        double scale = 1 / Vector3d.Dot(c0, r0);
        Vector3d x = b.Column0, y = b.Column1, z = b.Column2;
        return new Symmetric3(
            Vector3d.Dot(r0, x) * scale,
            Vector3d.Dot(r1, y) * scale,
            Vector3d.Dot(r2, z) * scale,
            (Vector3d.Dot(r0, y) + Vector3d.Dot(r1, x)) * 0.5 * scale,
            (Vector3d.Dot(r0, z) + Vector3d.Dot(r2, x)) * 0.5 * scale,
            (Vector3d.Dot(r1, z) + Vector3d.Dot(r2, y)) * 0.5 * scale);
    }

    public Vector3d Times(Vector3d v) => new(
        _xx * v.X + _xy * v.Y + _xz * v.Z,
        _xy * v.X + _yy * v.Y + _yz * v.Z,
        _xz * v.X + _yz * v.Y + _zz * v.Z);

    private Vector3d Column0 => new(_xx, _xy, _xz);

    private Vector3d Column1 => new(_xy, _yy, _yz);

    private Vector3d Column2 => new(_xz, _yz, _zz);
}

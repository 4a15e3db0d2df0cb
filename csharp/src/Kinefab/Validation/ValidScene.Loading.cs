using Kinefab.Diagnostics;
using Kinefab.Document;

namespace Kinefab.Validation;

/// <content>Reading and validating in one: apart, since the validator makes the scene.</content>
public sealed partial class ValidScene
{
    /// <summary>Reads and validates a file.</summary>
    /// <exception cref="SceneFormatException">The file has errors; the exception holds the report.</exception>
    public static ValidScene Load(string path, SceneReadOptions? options = null)
    {
        SceneReading reading = SceneFile.Load(path, options);
        if (reading.Document is null)
            throw new SceneFormatException(reading.Report);
        SceneValidation validation = SceneValidator.Validate(reading.Document, options?.Limits);
        return validation.Scene ?? throw new SceneFormatException(validation.Report);
    }
}

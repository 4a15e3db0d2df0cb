using System.Collections.Generic;
using System.IO;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Validation;

namespace KinefabUnity.Editing
{
    /// <summary>A file and what lies beside it.</summary>
    internal static class ImportedFile
    {
        /// <summary>Paths of the buffers that a scene names, in the project's terms; none of a file that is not read.</summary>
        internal static string[] Beside(string path, SceneDocument document)
        {
            var found = new List<string>();
            if (document != null)
            {
                int slash = path.LastIndexOf('/');
                string folder = slash < 0 ? "" : path.Substring(0, slash + 1);
                foreach (SceneBuffer buffer in document.Buffers)
                {
                    // A buffer without a name is in the file itself; a name that leads elsewhere is refused by the validator.
                    if (!string.IsNullOrEmpty(buffer.Uri) && Path.GetFileName(buffer.Uri) == buffer.Uri)
                    {
                        found.Add(folder + buffer.Uri);
                    }
                }
            }

            return found.ToArray();
        }

        /// <exception cref="SceneFormatException">The file has errors.</exception>
        internal static ValidScene Validated(SceneReading reading)
        {
            if (reading.Document == null)
            {
                throw new SceneFormatException(reading.Report);
            }

            SceneValidation validation = SceneValidator.Validate(reading.Document);
            return validation.Scene ?? throw new SceneFormatException(reading.Report.Concat(validation.Report));
        }
    }
}

#nullable enable
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Draws solids in the scene view, for scenes that a script builds when they are played: without them such
    /// a scene looks empty in the editor. Main thread, from OnDrawGizmos.</summary>
    public static class SceneSketch
    {
        /// <summary>Draws a solid. Everything but a cube is drawn as an ellipsoid.</summary>
        /// <param name="size">In metres, along the solid's own axes.</param>
        public static void Draw(PrimitiveType shape, Vector3 position, Quaternion rotation, Vector3 size, Color colour)
        {
            Matrix4x4 before = Gizmos.matrix;
            Gizmos.matrix = Matrix4x4.TRS(position, rotation, size);
            Gizmos.color = colour;
            if (shape == PrimitiveType.Cube)
            {
                Gizmos.DrawCube(Vector3.zero, Vector3.one);
            }
            else
            {
                Gizmos.DrawSphere(Vector3.zero, 0.5f);
            }
            Gizmos.matrix = before;
        }

        /// <summary>Draws a cuboid along the axes of the world.</summary>
        /// <param name="size">In metres.</param>
        public static void DrawBox(Vector3 centre, Vector3 size, Color colour) =>
            Draw(PrimitiveType.Cube, centre, Quaternion.identity, size, colour);
    }
}

using System;

namespace UnityEngine
{
    /// <summary>A pinhole camera with a screen of 1280 x 720 pixels.</summary>
    public sealed partial class Camera : Behaviour
    {
        public float fieldOfView { get; set; } = 60f;
        public int pixelWidth => 1280;
        public int pixelHeight => 720;

        public Ray ScreenPointToRay(Vector3 pos)
        {
            float scale = PixelSize();
            var local = new Vector3((pos.x - 0.5f * pixelWidth) * scale, (pos.y - 0.5f * pixelHeight) * scale, 1f);
            return new Ray(transform.position, transform.rotation * local);
        }

        public Vector3 WorldToScreenPoint(Vector3 position)
        {
            Vector3 local = Quaternion.Inverse(transform.rotation) * (position - transform.position);
            float scale = PixelSize() * local.z;
            return new Vector3(0.5f * pixelWidth + local.x / scale, 0.5f * pixelHeight + local.y / scale, local.z);
        }

        /// <summary>The size of a pixel at a distance of one metre.</summary>
        private float PixelSize() => (float)Math.Tan(0.5 * fieldOfView * Math.PI / 180.0) / (0.5f * pixelHeight);
    }

    public partial struct Color
    {
        /// <summary>Converts HSV to RGB after Smith, Color gamut transform pairs, 1978.</summary>
        public static Color HSVToRGB(float H, float S, float V)
        {
            float Channel(float shift)
            {
                float place = (shift + 6f * H) % 6f;
                return V - V * S * Math.Max(0f, Math.Min(1f, Math.Min(place, 4f - place)));
            }
            return new Color(Channel(5f), Channel(3f), Channel(1f));
        }
    }
}
